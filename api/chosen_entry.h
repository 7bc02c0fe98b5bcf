// One controller of a result, chosen by its number: the input of code and reports.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// The JSON text that contains the controller.
struct ResultSource {
    std::string_view result;        ///< a result, or a whole job with its request as the service returns it
    std::string_view request = {};  ///< its request if it is known; "": facts that only the request has are left out
};

struct ChosenEntry {
    Json result, request;         ///< the request is null if it is not known
    std::string job, name, date;  ///< of a whole job: id, name and finished_at; otherwise ""
    std::size_t index = 0;
    const Json& entry() const { return result.at("controllers").at(index); }
};

/// Chooses the controller number `index` (a decimal, from 0; "": the best of the result's ranking). Problems: 400 not
/// JSON; 404 no result, no such controller, or an entry without one. Throws Json::exception if the text only resembles
/// a result; not_a_result() is the answer to that.
std::variant<ChosenEntry, Problem> choose_entry(const ResultSource& source, std::string_view index);

/// Reads a result, or a job with its request, of any kind. Problems: 400 not JSON.
std::optional<Problem> read_result(const ResultSource& source, ChosenEntry& found);

/// The second half of choose_entry, applied to the output of read_result.
std::optional<Problem> find_entry(std::string_view index, ChosenEntry& found);

/// True if the result is about an operating range and has a schedule.
bool has_schedule(const Json& result);

Problem not_a_result();

}  // namespace tunewright::api
