"""Runs the commands of the documents as written, and compares their output with the documented one."""

import pathlib
import tempfile
import unittest

import documents
import service

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = ["README.md"] + [f"docs/{name}.md" for name in (
    "api", "batches", "check", "code", "command-line", "controllers", "interoperability", "jobs", "live", "mcp", "nonlinear",
    "plants", "range", "records", "relay", "report", "structures", "tutorial", "uncertain")]


def faults_of(name, text, port):
    with tempfile.TemporaryDirectory(prefix="tunewright-docs-") as folder:
        return documents.faults(name, text, port, service.BINARY, pathlib.Path(folder))


class DocumentTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.service = service.Service()
        cls.addClassCleanup(cls.service.__exit__)

    def holds(self, name):
        text = (ROOT / name).read_text(encoding="utf-8")
        blocks = [block for block in documents.commands_of(text) if block.run]
        self.assertTrue(blocks, f"{name} has no block of commands.")
        if found := faults_of(name, text, self.service.port):
            self.fail("\n\n".join(found))

    def test_a_wrong_figure_a_failing_command_and_a_refused_request_are_found(self):
        call = "curl -s http://127.0.0.1:8080/v1/"
        body = """-H 'Prefer: wait=10' -d '{"plant": {"type": "fopdt", "K": 2, "T": 10, "L": 3}, "tune": [{"method": "simc"}]}'"""
        made = (f"```sh\n{call}jobs {body}\n```\n\nBy SIMC Kp is T/(2 K L):\n\n"
                '```json\n{..., "result": {..., "controllers": [{..., "controller": {..., "Kp": 0.8333, ...}, ...}], ...}, ...}\n'
                "```\n\n```sh\necho 1.4\n```\n")
        self.assertEqual([], faults_of("made.md", made, self.service.port))
        wrong = made.replace("0.8333", "0.8334") + "```sh\nfalse\n```\n<!-- not run: no -->\n```sh\nfalse\n```\n" \
            f"```sh\n{call}jobs -d '{{}}'\n```\n"
        found = faults_of("made.md", wrong, self.service.port)
        self.assertEqual(["made.md:1:", "made.md:14:", "made.md:21:"], [fault.split(" ")[0] for fault in found], found)


for document in DOCUMENTS:
    setattr(DocumentTest, "test_the_commands_of_%s_print_what_it_says" % document.replace("/", "_").replace(".md", ""),
            lambda self, name=document: self.holds(name))


class DifferenceTest(unittest.TestCase):
    """Tests of the comparison itself."""

    def same(self, expected, came):
        self.assertIsNone(documents.difference(expected, came))

    def other(self, expected, came):
        self.assertIsNotNone(documents.difference(expected, came))

    def test_numbers_count_to_the_digits_shown(self):
        self.same("Kp 0.838", "Kp 0.8381044")
        self.same("1.12e-06", "1.1249e-06")
        self.same("5", "5.4")
        self.other("Kp 0.838", "Kp 0.8386")
        self.other("0.8380", "0.8381044")
        self.other("1.12e-06", "1.126e-06")
        self.other("-1", "1")
        self.other("12", "a")
        self.same("0.69537...", "0.6953738840424818")
        self.other("0.69538...", "0.6953738840424818")

    def test_blanks_do_not_count_and_words_do(self):
        self.same('{"a": [1,\n  2]}', '{"a":[1,2]}')
        self.other("stable", "unstable")
        self.other("one two", "one two three")
        self.other("one two three", "one two")

    def test_dots_leave_out_whole_members_and_at_the_end_everything(self):
        self.same('{"a": 1, ..., "d": 4}', '{"a":1,"b":{"d":5},"c":[6],"d":4}')
        self.same("one ... four", "one two three four")
        self.same('{"a": {"b": 1, ...', '{"a": {"b": 1, "c": 2}, "d": 3}')
        self.same('{..., "a": 1, ...}', '{"a": 1}')
        self.other('{"a": {"b": 1, ..., "d": 3}}', '{"a": {"b": 1, "c": 2}, "d": 3}')
        self.other('[{"Ms": 1.4, ...}, ...]', '[{"Ms": 1.5}, {"Ms": 1.4}]')

    def test_commands_are_read_with_what_they_print_up_to_the_next_heading(self):
        text = "```sh\na\n```\nThen\n```json\n1\n```\n```text\n2\n```\n# Next\n```json\n3\n```\n" \
               "<!-- not run: it needs a network -->\n```sh\nb\n```\n"
        first, second = documents.commands_of(text)
        self.assertEqual((1, "a", True, ["1", "2"]), (first.line, first.text, first.run, first.printed))
        self.assertEqual(("b", False, []), (second.text, second.run, second.printed))


if __name__ == "__main__":
    unittest.main()
