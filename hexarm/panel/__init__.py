"""One local web page to watch and drive a machine: docs/panel.md."""
