"""Which connections are the page's own."""

import pytest

from hexarm.panel.nodes.web_server import refusal

NAMES = ('bench-3', 'bench-3.local')


@pytest.mark.parametrize(
    ('host', 'origin'),
    [
        ('127.0.0.1:8080', 'http://127.0.0.1:8080'),
        ('localhost:8080', 'http://localhost:8080'),
        ('[::1]:8080', 'http://[::1]:8080'),
        ('192.168.1.20:8080', 'http://192.168.1.20:8080'),
        ('Bench-3.local:8080', 'http://bench-3.local:8080'),
        ('127.0.0.1:8080', None),
    ],
)
def test_the_page_itself_is_welcome(host, origin):
    assert refusal(host, origin, NAMES) == ''


@pytest.mark.parametrize(
    ('host', 'origin', 'word'),
    [
        ('127.0.0.1:8080', 'https://elsewhere.example', 'elsewhere.example'),
        ('127.0.0.1:8080', 'http://127.0.0.1:9090', '9090'),
        ('127.0.0.1:8080', 'null', 'may not move'),
        ('elsewhere.example:8080', 'http://elsewhere.example:8080', 'not called'),
        ('elsewhere.example:8080', None, 'not called'),
        ('', None, 'not called'),
        ('[::1', None, 'is none'),
    ],
)
def test_others_are_refused_by_name(host, origin, word):
    assert word in refusal(host, origin, NAMES)
