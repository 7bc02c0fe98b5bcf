#include "server/identify_command.h"

#include <iostream>

#include "server/http/problems.h"
#include "server/input_file.h"

namespace tunewright::server {
namespace {

// A request is one JSON object; a log may have one in each line.
bool is_request(const std::string& text) {
    constexpr const char* kBlank = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string::npos || text[first] != '{') return false;
    const std::size_t end = text.find('\n', first);
    if (end == std::string::npos) return true;
    const std::size_t last = text.find_last_not_of(kBlank, end), next = text.find_first_not_of(kBlank, end);
    return !(text[last] == '}' && next != std::string::npos && text[next] == '{');
}

}  // namespace

int identify(const IdentifyCommand& command) {
    std::string text;
    if (!read_input(command.file, text)) {
        std::cerr << api::to_json(http::problem(404, "The file " + command.file + " cannot be read.")) << "\n";
        return 1;
    }
    const api::Answer answer =
        is_request(text) ? api::identify_call(text, {}) : api::identify_csv(std::move(text), command.question, {});
    const bool failed = answer.status >= 400;
    (failed ? std::cerr : std::cout) << answer.body << "\n";
    return failed ? 1 : 0;
}

}  // namespace tunewright::server
