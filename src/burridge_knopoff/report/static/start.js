startTheme();
if (runs) startRuns();
startPictures();
startCharts();
