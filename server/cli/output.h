// How the commands answer: short tables for a person at a terminal, JSON for a program, problems on standard error.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "api/json/problem.h"

namespace tunewright::server {

/// How an answer is asked for. Without a word it is as the reader needs it: a table, or lines of JSON, on a terminal,
/// and compact JSON elsewhere.
struct OutputWords {
    bool json = false;    ///< compact, on a terminal too
    bool pretty = false;  ///< indented JSON
    bool table = false;   ///< the table, elsewhere too
};

using Table = std::function<std::string(std::string_view json)>;

/// Whether the table is what such an answer is written as.
bool wants_table(const OutputWords& words);

/// Writes an answer to standard output and returns 0. `table`: none where the answer has no shorter form than JSON.
int write_answer(std::string_view json, const OutputWords& words, const Table& table = {});

/// Writes a text to standard output as it is and returns 0; 1, with a sentence, where it cannot be written.
int write_text(std::string_view text);

/// Writes a problem to standard error, as sentences on a terminal and as JSON elsewhere, and returns 1. `file`: whose
/// text it is about, "-" for standard input, "" for none.
int write_problem(std::string_view problem_json, const OutputWords& words, const std::string& file = "");
int write_problem(const api::Problem& problem, const OutputWords& words, const std::string& file = "");

/// All of the file, or of standard input for "-". False where it cannot be read.
bool read_input(const std::string& file, std::string& text);

/// Of a file that cannot be read.
api::Problem unreadable(const std::string& file);

}  // namespace tunewright::server
