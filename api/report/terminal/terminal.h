// Output for a person on a terminal instead of an answer's JSON: short tables, sentences, and responses in dots.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

#include "api/chosen_entry.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// A result of tune: its model if a record was given, a row for each controller in the order of the ranking with
/// settings, Ms, Mt and load IAE, and of the best the verdict and the settings of its product. Any other text is
/// returned unchanged.
std::string result_text(std::string_view result);
/// The same with the first rows alone.
std::string shortened_result_text(std::string_view result, std::size_t max_rows);

/// The settings of a product with their units, and the deviations from the design: of an answer of settings, or of an
/// entry's `as_entered`. Any other text is returned unchanged.
std::string settings_text(std::string_view entered);

/// A result about a range: one setting, the schedule's rows with their figures, the worst over the range, the areas of
/// the runs and the verdict. Any other text is returned unchanged.
std::string range_text(std::string_view result);

/// An answer of a check, in the order of its ranking: a row for each loop with cause, confidence, what to do, owner,
/// gain and period; loops that oscillate together; cascades; and sentences about the first loops. Any other text is
/// returned unchanged.
std::string check_text(std::string_view answer);

/// An answer about a structure: its conclusions, controllers and figures. Any other text is returned unchanged.
std::string structure_text(std::string_view answer);

/// An answer of score: counts, ratios, range, and the problems without a solution. Any other text is returned
/// unchanged.
std::string score_text(std::string_view answer);

/// An answer of identify: the candidates with their fits, the chosen one's parameters with standard errors, warnings.
std::string model_text(std::string_view answer);

/// Lists of the methods, the products and the examples.
std::string methods_text(std::string_view answer);
std::string controllers_text(std::string_view answer);
std::string examples_text(std::string_view answer);

/// A problem about the text of a file, with the file's name instead of "the body"; unchanged if `file` is "".
std::string problem_of_file(std::string_view problem, const std::string& file);

/// The reason of a failure, and each fault with its place and cure.
std::string problem_text(std::string_view problem);

/// The responses of a controller of a result (`index` as in choose_entry), drawn in the dots of Braille letters, 72
/// letters wide, or as an SVG file. Problems: as in choose_entry(), and 422 if the result has no traces.
std::variant<std::string, Problem> responses_text(const ResultSource& source, std::string_view index);
std::variant<std::string, Problem> responses_svg(const ResultSource& source, std::string_view index);

}  // namespace tunewright::api
