"""How the panel speaks to the graph."""

from hexarm.panel.nodes.request_client import RequestClient


class Publishers:
    """Stands for a node: remembers what is published how."""

    def __init__(self):
        self.depths = {}

    def create_publisher(self, _, topic, qos):
        self.depths[topic] = qos.depth

    def create_client(self, *_):
        return None

    def create_subscription(self, *_):
        return None


def test_many_stops_in_a_row_all_arrive():
    node = Publishers()
    RequestClient(node, bool)
    assert node.depths['emergency_stop'] == 100
