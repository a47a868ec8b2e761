"""What the nodes say of themselves, as a table in Markdown."""

from hexarm.panel.view import NodeReport

SIGNS = ('✓', '⚠', '✗', '✗')
"""By the level of a DiagnosticStatus; signs that every system's letters have."""

SILENT = 3.0
"""Seconds after which a node that reports once a second is said to be silent."""


def diagnostics_text(nodes: tuple[NodeReport, ...]) -> str:
    """One block for each node: its own words, then its values."""
    if not nodes:
        return 'No node has reported yet.'
    return '\n\n'.join(_block(node) for node in nodes)


def _block(node: NodeReport) -> str:
    is_silent = node.age > SILENT
    sign = SIGNS[2] if is_silent else SIGNS[min(max(node.level, 0), 3)]
    said = f'silent for {node.age:.0f} s' if is_silent else node.message
    rows = [f'| {_cell(name)} | {_cell(value)} |' for name, value in node.values.items() if value]
    table = '\n'.join(['| | |', '|---|---|', *rows]) if rows else ''
    return f'{sign} **{_cell(node.name)}** {_cell(said)}\n\n{table}'


def _cell(text: str) -> str:
    """Without what would end the cell or begin markup; underscores as they are in keys."""
    clean = ' '.join(text[:120].split())
    for sign in '\\|<>*_`[]':
        clean = clean.replace(sign, f'\\{sign}')
    return clean
