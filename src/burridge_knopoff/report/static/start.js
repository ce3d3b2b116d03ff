startTheme();
startRuns();
startPictures();
fillLegends();
themeListeners.push(fillLegends);
startCharts();
