"""The claims of the paper. Each is judged by a function that turns summaries into a verdict."""
