"""A short round of calls made up from the service's own document, the same each time."""

import collections
import unittest

from api_fuzz import OPTIONS, Api, round_of_calls
from service import Service


class ApiFuzzTest(unittest.TestCase):
    def test_made_up_calls_get_documented_answers(self):
        counts = collections.Counter()
        with Service(*OPTIONS) as service:
            api = Api(service.get("/openapi.json").json)
            round_of_calls(service, api, 1500, counts=counts)
        self.assertEqual({name for name, _ in counts}, {operation["operationId"] for _, _, operation in api.operations})
        self.assertGreater(sum(count for (_, status), count in counts.items() if status < 300), 200)


if __name__ == "__main__":
    unittest.main()
