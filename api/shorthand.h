// The tuning request that a few words of a command line stand for, with a file or without one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// What a CSV file leaves open, in words: members of the request's record, units and identify; "" where not given.
struct CsvRequest {
    std::string t, u, y, r;  ///< headings, or numbers from 1
    std::string dt, time_unit, kind, model;
    std::vector<std::string> d;         ///< headings or numbers of measured disturbances
    std::vector<std::string> u_limits;  ///< low and high; empty: not given
    std::vector<std::string> u_step;    ///< from and to; empty: not given
    std::string u0, y0, run;
    std::string answer_unit;  ///< of the times of the answer
    bool traces = false;
};

struct TuneWords {
    std::string plant;                 ///< as `tunewright plant` reads it; "": the file has it
    std::vector<std::string> methods;  ///< empty: those of the file, or the default
    std::string Ms;  ///< limit of Ms and Mt for robust and all; where neither is asked for, Ms of each; "": not given
    std::string baseline;   ///< today's settings, "Kp Ti Td"; "": those of the file, or none
    std::string Ku, Pu, K;  ///< in place of a plant and a file: the ultimate point, perhaps the static gain
    CsvRequest record;      ///< where the file is a recorded test; for a plant, its time_unit is that of all times
};

/// The member `record` of a request, with that text.
Json record_of(const CsvRequest& question, std::string csv);

/// A text in any encoding that is one JSON object, which a log with one in each line is not, as UTF-8; else nothing.
std::optional<std::string> request_text(const std::string& text);

/// The request as JSON. `file`: a request, a recorded test as CSV or as JSON lines in any encoding; none where the
/// words have a plant. Words stand above what the file says. Problems: 400 for a request that is not JSON; 422 where
/// there is neither plant nor file, or both; whatever else is wrong prepare_job() finds.
std::variant<std::string, Problem> tuning_request(const TuneWords& words, std::optional<std::string> file);

}  // namespace tunewright::api
