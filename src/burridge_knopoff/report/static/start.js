// Without decompression there are pictures in the place of charts.
if (document.documentElement.classList.contains("js")) {
  startTheme();
  if (runs) {
    startBlocks();
    startRuns();
  }
  startPictures();
  startClaims();
  startCharts();
  startAddress();
}
