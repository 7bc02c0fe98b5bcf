#include "server/identify_command.h"

#include <iostream>

#include "server/http/problems.h"
#include "server/input_file.h"

namespace tunewright::server {
namespace {

bool is_request(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
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
