#include "server/cli/output.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include "api/json/json.h"
#include "api/report/terminal/terminal.h"
#include "server/http/app/problems.h"

namespace tunewright::server {
namespace {

enum class Form { compact, indented, table };

Form form_of(const OutputWords& words, int stream) {
    if (words.json) return Form::compact;
    if (words.pretty) return Form::indented;
    return words.table || isatty(stream) ? Form::table : Form::compact;
}

}  // namespace

bool wants_table(const OutputWords& words) { return form_of(words, STDOUT_FILENO) == Form::table; }

int write_answer(std::string_view json, const OutputWords& words, const Table& table) {
    const Form form = form_of(words, STDOUT_FILENO);
    if (form == Form::compact) return write_text(std::string(json) + "\n");
    return write_text(form == Form::table && table ? table(json) : api::indented(json));
}

int write_text(std::string_view text) {
    std::cout << text << std::flush;
    if (std::cout) return 0;
    std::cerr << "tunewright: the answer cannot be written to standard output.\n";
    return 1;
}

int write_problem(std::string_view problem_json, const OutputWords& words, const std::string& file) {
    const std::string named = api::problem_of_file(problem_json, file == "-" ? "standard input" : file);
    switch (form_of(words, STDERR_FILENO)) {
        case Form::compact: std::cerr << named << "\n"; break;
        case Form::indented: std::cerr << api::indented(named); break;
        case Form::table: std::cerr << api::problem_text(named); break;
    }
    return 1;
}

int write_problem(const api::Problem& problem, const OutputWords& words, const std::string& file) {
    return write_problem(api::to_json(problem), words, file);
}

bool read_input(const std::string& file, std::string& text) {
    if (file == "-") {
        text.assign(std::istreambuf_iterator<char>(std::cin), {});
        return true;
    }
    std::error_code unknown;
    if (std::filesystem::is_directory(file, unknown)) return false;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return false;
    // A pipe has no size and cannot be positioned.
    if (std::filesystem::is_regular_file(file, unknown)) text.reserve(std::filesystem::file_size(file, unknown));
    std::array<char, 1 << 16> piece;
    while (stream.read(piece.data(), piece.size()) || stream.gcount() > 0)
        text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    return stream.eof();
}

api::Problem unreadable(const std::string& file) { return http::problem(404, "The file " + file + " cannot be read."); }

}  // namespace tunewright::server
