"""Verdicts follow from numbers: the paper's, ours, and how far apart they may be."""

import pytest

from hexarm.papers.finding import ROTARY, Claim, Finding, unstated


def finding(claim, *values):
    return Finding('key', ROTARY, 'topic', claim, 'ours', values, 'mm', 0.1, 'reason')


@pytest.mark.parametrize(
    ('value', 'verdict'),
    [
        (15.6, 'agrees'),
        (15.65, 'agrees'),
        (15.49, 'partly'),
        (16.59, 'partly'),
        (16.7, 'contradicts'),
        (-15.6, 'contradicts'),
        (float('nan'), 'contradicts'),
    ],
)
def test_an_equal_claim_is_judged_by_the_distance(value, verdict):
    assert finding(Claim('15.6', (15.6,), 0.1, 1.0), value).verdict == verdict


@pytest.mark.parametrize(
    ('side', 'value', 'verdict'),
    [
        ('at most', 600.0, 'agrees'),
        ('at most', -700.0, 'agrees'),
        ('at most', 700.0, 'contradicts'),
        ('at least', 600.0, 'agrees'),
        ('at least', 500.0, 'contradicts'),
    ],
)
def test_a_bound_is_judged_on_its_wrong_side_only(side, value, verdict):
    assert finding(Claim('600', (600.0,), side=side), value).verdict == verdict


def test_the_worst_of_several_values_decides():
    claim = Claim('−15.1 … 19.6', (-15.1, 19.6), 0.1, 1.0)
    assert finding(claim, -15.1, 19.6).verdict == 'agrees'
    assert finding(claim, -15.1, 19.0).verdict == 'partly'
    assert finding(claim, -13.0, 19.6).verdict == 'contradicts'
    with pytest.raises(ValueError, match='zip'):
        _ = finding(claim, 19.6).verdict


def test_a_requirement_is_met_or_missed():
    claim = Claim('< 20 ms', (20.0,), side='at most', is_requirement=True)
    assert finding(claim, 3.4).verdict == 'meets'
    assert finding(claim, 20.1).verdict == 'misses'


def test_without_a_number_there_is_no_verdict():
    assert finding(unstated(), 1.0).verdict == 'not stated'
    assert unstated().rule('mm') == ''


def test_the_rule_says_how_the_verdict_comes_about():
    assert Claim('', (-15.1, 19.6), 0.1, 1.0).rule('mm') == '−15.1, 19.6 mm ± 0.1; partly ± 1'
    assert Claim('', (600.0,), side='at most').rule('°/s') == 'at most 600 °/s'
