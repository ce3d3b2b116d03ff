startTheme();
startRuns();
startPictures();
startCharts();
