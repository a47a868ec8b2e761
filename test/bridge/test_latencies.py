from bridge.latencies import Latencies, percentiles_ms


def test_percentiles_are_milliseconds_under_telling_names():
    report = percentiles_ms('trip', [k / 1000 for k in range(100)])
    assert report == {'trip_p50_ms': 50.0, 'trip_p99_ms': 99.0}


def test_nothing_measured_is_nothing_reported():
    assert Latencies().report('trip') == {}


def test_only_the_newest_count_and_negative_ones_are_zero():
    latencies = Latencies(keep=3)
    for seconds in (9.0, 0.001, -1.0, 0.002):
        latencies.add(seconds)
    assert latencies.report('trip') == {'trip_p50_ms': 1.0, 'trip_p99_ms': 2.0}
