// What a person reads on a terminal instead of an answer's JSON: short tables, sentences, and responses in dots.
#pragma once

#include <string>
#include <string_view>
#include <variant>

#include "api/chosen_entry.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// A result of tune: its model where a record was given, a row for each controller in the order of the ranking with
/// settings, Ms, Mt and load IAE, and the verdict on the best. A text that is no result is answered as it is.
std::string result_text(std::string_view result);

/// A result about a range: one setting, the schedule's rows with their figures, the worst over the range, the runs'
/// areas and the verdict. A text that is no such result is answered as it is.
std::string range_text(std::string_view result);

/// An answer of identify: the candidates with their fits, the chosen one's parameters with standard errors, warnings.
std::string model_text(std::string_view answer);

/// Lists: the methods, the products, the examples.
std::string methods_text(std::string_view answer);
std::string controllers_text(std::string_view answer);
std::string examples_text(std::string_view answer);

/// A problem about the text of a file, which then is named instead of the body of a call; `file` "": as it is.
std::string problem_of_file(std::string_view problem, const std::string& file);

/// Why something could not be done, and each fault with its place and cure.
std::string problem_text(std::string_view problem);

/// The responses of a controller of a result (`index` as for choose_entry), drawn in the dots of Braille letters, 72
/// letters wide, or as a file of SVG. Problems: as choose_entry(), and 422 where the result has no traces.
std::variant<std::string, Problem> responses_text(const ResultSource& source, std::string_view index);
std::variant<std::string, Problem> responses_svg(const ResultSource& source, std::string_view index);

}  // namespace tunewright::api
