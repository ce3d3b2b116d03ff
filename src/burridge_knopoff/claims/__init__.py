"""The claims of the paper, each judged by a function from summaries to a verdict."""
