#include "server/cli/output.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include "api/json/json.h"
#include "api/report/terminal.h"
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
    if (form == Form::compact) {
        std::cout << json << "\n";
    } else {
        std::cout << (form == Form::table && table ? table(json) : api::indented(json));
    }
    std::cout.flush();
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
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) return false;
    const std::streamoff size = stream.tellg();
    if (size < 0) {  // a pipe has no size
        stream.clear();
        text.assign(std::istreambuf_iterator<char>(stream), {});
        return !stream.bad();
    }
    text.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(text.data(), size);
    return static_cast<bool>(stream);
}

api::Problem unreadable(const std::string& file) { return http::problem(404, "The file " + file + " cannot be read."); }

}  // namespace tunewright::server
