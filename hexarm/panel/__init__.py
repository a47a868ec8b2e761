"""One local web page to look at a machine and to hold it: docs/panel.md."""
