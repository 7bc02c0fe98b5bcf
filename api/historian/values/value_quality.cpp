#include "api/historian/values/value_quality.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "api/csv/cell.h"
#include "api/csv/columns/heading_words.h"

namespace tunewright::api {
namespace {

constexpr double kGoodOpcDa = 192, kMaxOpcDa = 255, kUncertainOpcUa = 0x40000000;

std::optional<double> code_of(std::string_view cell) {
    double code = 0;
    return read_cell_number(cell, code) ? std::optional(code) : std::nullopt;
}

bool is_opc_da(double code) { return code >= kGoodOpcDa && code <= kMaxOpcDa; }

}  // namespace

bool is_bad_quality(std::string_view word) {
    static constexpr std::string_view kBad[] = {
        "bad",      "uncertain", "questionable",    "poor",        "invalid", "unreliable",
        "schlecht", "unsicher",  "mauvais",         "incertain",   "malo",    "mala",
        "incierto", "slecht",    "ung\xC3\xBCltig", "substituted", "suspect", "not"};
    std::size_t length = 0;
    while (length < word.size() && (std::isalpha(static_cast<unsigned char>(word[length])) || (word[length] & 0x80)))
        ++length;
    if (length == 0) return false;
    return is_one_of(lower_case(word.substr(0, length)), kBad);
}

void ValueQuality::look_at(std::string_view cell) {
    if (const auto code = opc_da_ ? std::nullopt : code_of(cell)) opc_da_ = is_opc_da(*code);
}

bool ValueQuality::is_bad(std::string_view cell) {
    if (cell.empty()) return false;
    const auto code = code_of(cell);
    if (!code) return is_bad_quality(cell);
    opc_da_ = opc_da_ || is_opc_da(*code);
    return *code >= kUncertainOpcUa || (opc_da_ && *code < kGoodOpcDa);
}

}  // namespace tunewright::api
