// Builds a tuning request from the options of a command line, with or without a file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/json/json.h"
#include "api/json/problem.h"

namespace tunewright::api {

/// Options for reading a CSV file: members of the request's record, units and identify; "" if not given.
struct CsvRequest {
    std::string t, u, y, r, mode;  ///< headings, or numbers from 1
    std::string dt, time_unit, kind, model;
    std::vector<std::string> d;         ///< headings or numbers of measured disturbances
    std::vector<std::string> u_limits;  ///< low and high; empty: not given
    std::vector<std::string> u_step;    ///< from and to; empty: not given
    std::string u0, y0, run;
    std::string answer_unit;  ///< of the times of the answer
    bool traces = false;
};

struct TuneWords {
    std::string plant;                 ///< the plant as `tunewright plant` reads it; "": it is in the file
    std::vector<std::string> methods;  ///< empty: those of the file, or the default
    std::string Ms;         ///< limit of Ms and Mt for robust and all; without either method, Ms of each; "": not given
    std::string baseline;   ///< today's settings: "Kp Ti Td", a text, "from-record"; "": those of the file, or none
    std::string Ku, Pu, K;  ///< instead of a plant and a file: the ultimate point, and optionally the static gain
    std::vector<std::string> set;  ///< "MEMBER=VALUE": any member of the request, after all others
    CsvRequest record;             ///< if the file is a recorded test; for a plant, its time_unit is that of all times
};

/// The member `record` of a request, with that text.
Json record_of(const CsvRequest& question, std::string csv);

/// The request of POST /v1/records/controller for a file in any encoding.
std::string controller_record_request(const CsvRequest& question, const std::string& file);

/// The text as UTF-8 if it is one JSON object in any encoding; a log with an object in each line is not. Otherwise
/// empty.
std::optional<std::string> request_text(const std::string& text);

/// The request as JSON. `file`: a request, a recorded test as CSV or as JSON lines in any encoding; none if the options
/// have a plant. Options override the file. Problems: 400 for a request that is not JSON; 422 if there is neither plant
/// nor file, or both; prepare_job() finds all other faults.
std::variant<std::string, Problem> tuning_request(const TuneWords& words, std::optional<std::string> file);

}  // namespace tunewright::api
