// Output of the commands: short tables for a person at a terminal, JSON for a program, problems on standard error.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "api/json/problem.h"

namespace tunewright::server {

/// The output format. By default it suits the reader: a table, or indented JSON, on a terminal, and compact JSON
/// elsewhere.
struct OutputWords {
    bool json = false;    ///< compact JSON, also on a terminal
    bool pretty = false;  ///< indented JSON
    bool table = false;   ///< the table, also elsewhere
};

using Table = std::function<std::string(std::string_view json)>;

/// True if such an answer is written as a table.
bool wants_table(const OutputWords& words);

/// Writes an answer to standard output and returns 0. `table`: none if the answer has no form other than JSON.
int write_answer(std::string_view json, const OutputWords& words, const Table& table = {});

/// Writes a text to standard output unchanged and returns 0; 1, with a sentence, if it cannot be written.
int write_text(std::string_view text);

/// Writes a problem to standard error, as sentences on a terminal and as JSON elsewhere, and returns 1. `file`: the
/// file that the problem is about, "-" for standard input, "" for none.
int write_problem(std::string_view problem_json, const OutputWords& words, const std::string& file = "");
int write_problem(const api::Problem& problem, const OutputWords& words, const std::string& file = "");

/// Reads all of the file, or of standard input for "-". False if it cannot be read.
bool read_input(const std::string& file, std::string& text);

/// The problem for a file that cannot be read.
api::Problem unreadable(const std::string& file);

}  // namespace tunewright::server
