// The parameters behind the question mark: how they are read, and how faults in them are told.
#pragma once

#include <charconv>
#include <string>

#include "api/problem.h"

namespace tunewright::server {

/// Most jobs or batches on a page.
inline constexpr int kLargestPage = 200;

/// 422 for the parameters of what is named ("list"), without a fault yet.
api::Problem bad_parameters(const char* of);

/// Adds a fault: the parameter, its value, the rule. What is no UTF-8 is shown as if it were Windows-1252: an answer is
/// always text.
void refuse_parameter(api::Problem& problem, const std::string& name, const std::string& value,
                      const std::string& rule);

/// False where the text is no whole number within the bounds.
template <class Number>
bool read_whole(const std::string& text, Number least, Number most, Number& target) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), target);
    return error == std::errc{} && end == text.data() + text.size() && target >= least && target <= most;
}

}  // namespace tunewright::server
