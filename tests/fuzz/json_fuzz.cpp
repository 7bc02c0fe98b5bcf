// libFuzzer on the parser of JSON text: it accepts the same bytes as the tree library's own reader, with the same
// values, or reports the fault in readable words.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

#include "api/json/json.h"
#include "api/json/utf8.h"

namespace {

using namespace tunewright::api;

void require(bool holds, const char* what, std::string_view text) {
    if (holds) return;
    std::cerr << "broken promise: " << what << "\n" << text << "\n";
    std::abort();
}

/// JSON that is refused: by the contract's own limits, or for a zero byte, which the other reader takes for the end.
bool may_differ(const Problem& problem, std::string_view text) {
    return problem.status == 422 || text.find('\0') != text.npos;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto answer = parse(text);
    if (const auto* problem = std::get_if<Problem>(&answer)) {
        require(!problem->detail.empty() && is_utf8(problem->detail), "a readable problem", text);
        require(may_differ(*problem, text) || !Json::accept(text), "what is JSON is taken", text);
        return 0;
    }
    require(Json::accept(text), "what is not JSON is refused", text);
    require(std::get<Json>(answer).dump() == Json::parse(text).dump(), "the same values", text);
    return 0;
}
