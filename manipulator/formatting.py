"""How messages write lengths, counts and the reasons of the operating system."""

import difflib
import math
from collections.abc import Iterable

MOST_DIGITS = 12
"""Values that differ after them are the same, but for rounding."""

MOST_SHOWN = 80
"""Characters of an input that a message repeats."""

METRES_FROM = 0.9999
"""m. Shorter lengths are given in millimetres."""


def length(metres: float, digits: int = 4) -> str:
    """A length for people, without powers of ten: '22.8 mm', from a metre on '45.2 m'."""
    value, unit = (metres, 'm') if abs(metres) > METRES_FROM else (1e3 * metres, 'mm')
    return f'{plain(value, digits)} {unit}'


def plain(value: float, digits: int = 4) -> str:
    """With so many digits that count, without powers of ten and zeros at the end."""
    return f'{round(float(f"{value:.{digits}g}"), 10) + 0.0:.10f}'.rstrip('0').rstrip('.')


def told_apart(numbers: Iterable[float], fewest: int = 6) -> list[str]:
    """With so many digits, or with as many as values that differ need to look different."""
    values, texts = [float(f'{n:.{MOST_DIGITS}g}') for n in numbers], list[str]()
    for digits in range(fewest, MOST_DIGITS + 1):
        texts = [f'{value:.{digits}g}' for value in values]
        if len(set(texts)) == len(set(values)):
            break
    return texts


def decimals(largest: float, digits: int = 4, fewest: int = 4) -> int:
    """After the point, so that the largest of some numbers has so many digits that count."""
    if not 0.0 < largest < math.inf:
        return fewest
    return max(fewest, digits - 1 - math.floor(math.log10(largest)))


def counted(count: int, one: str, many: str = '') -> str:
    """A count and its noun: '1 pose', '2,000 poses'; `many` where it is not one with an s."""
    return f'{count:,} {one if count == 1 else many or one + "s"}'


def shown(value: object) -> str:
    """An input as a message repeats it: as Python writes it, its beginning where it is long."""
    return shortened(repr(value[: MOST_SHOWN + 1] if isinstance(value, str) else value))


def nearest(word: str, choices: Iterable[str]) -> str:
    """The choice that a misspelt word means; empty where none is near."""
    return next(iter(difflib.get_close_matches(word, list(choices), n=1)), '')


def did_you_mean(word: str) -> str:
    """The end of a sentence about a misspelt word: empty for none."""
    return f', did you mean {word!r}?' if word else ''


def not_one_of(value: object, choices: Iterable[object]) -> str:
    """Of an input that must be one of a few words: "'fre' is not one of free, parallel, …"."""
    words = [str(choice) for choice in choices]
    near = nearest(str(value)[:MOST_SHOWN], words)
    return f'{shown(value)} is not one of {", ".join(words)}{did_you_mean(near)}'


def shortened(text: str, most: int = MOST_SHOWN) -> str:
    """A text, or the beginning of a long one and that it is cut."""
    return text if len(text) <= most else f'{text[:most]}…'


def reason(error: Exception) -> str:
    """Why a file could not be used, without numbers of errors and the file's name again."""
    if isinstance(error, UnicodeDecodeError):
        return f'it is no text in UTF-8 (byte {error.start})'
    return (isinstance(error, OSError) and error.strerror) or str(error)
