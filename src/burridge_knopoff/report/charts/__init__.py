"""The interactive charts of the report: plotly figures, one module per section of the page."""
