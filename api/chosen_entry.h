// A controller of a result, by its number: what code and reports are made of.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// Where the controller comes from, as JSON text.
struct ResultSource {
    std::string_view result;        ///< a result, or a whole job as the service shows it, with its request
    std::string_view request = {};  ///< its request where it is known; "": what only that tells is left out
};

struct ChosenEntry {
    Json result, request;         ///< the request null where it is not known
    std::string job, name, date;  ///< of a whole job: id, name and finished_at; else ""
    std::size_t index = 0;
    const Json& entry() const { return result.at("controllers").at(index); }
};

/// Number `index` (a decimal, from 0; "": the best of the result's ranking). Problems: 400 not JSON; 404 no result, no
/// such controller, or an entry without one. Throws Json::exception where the text only looks like a result;
/// not_a_result() is the answer to that.
std::variant<ChosenEntry, Problem> choose_entry(const ResultSource& source, std::string_view index);

/// A result alone, or a job with its request, whatever it answers. Problems: 400 not JSON.
std::optional<Problem> read_result(const ResultSource& source, ChosenEntry& found);

/// The second half of choose_entry, of what read_result has read.
std::optional<Problem> find_entry(std::string_view index, ChosenEntry& found);

/// Whether it answers about an operating range, and has a schedule.
bool has_schedule(const Json& result);

Problem not_a_result();

}  // namespace tunewright::api
