"""What a recorder says of topics that it did not hear: misspelt, silent, or no machine at all."""

import difflib
from collections.abc import Collection, Sequence

from hexarm.namespaces import nobody_in

NEAREST = 3


def unheard(names: Sequence[str], heard: Collection[str], there: Collection[str]) -> list[str]:
    """One line for each of the topics asked for that is not among those `heard`."""
    lines = []
    for name in sorted(set(names) - set(heard)):
        if name in there:
            lines.append(f'{name} is there, but nobody said anything on it')
        else:
            lines.append(f'there is no topic {name}{_near(name, there)}')
    return lines


def nothing(namespace: str, lines: Sequence[str], there: Collection[str], domain: int) -> str:
    """Why not one message was heard: the `lines` of topics asked for, or nobody is there."""
    if any(topic.startswith(f'/{namespace}/') for topic in there):
        return '; '.join(lines) or f'nobody said anything in /{namespace}'
    reason = nobody_in(namespace, there, domain)
    return '; '.join([reason, *lines])


def _near(name: str, there: Collection[str]) -> str:
    """Compared without the namespace that they share, which would make all of them alike."""
    space = name[: name.find('/', 1) + 1]
    inside = {topic.removeprefix(space): topic for topic in there if topic.startswith(space)}
    near = difflib.get_close_matches(name.removeprefix(space), inside, n=NEAREST)
    return f', did you mean {" or ".join(inside[n] for n in near)}?' if near else ''
