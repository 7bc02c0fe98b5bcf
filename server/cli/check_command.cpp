// `tunewright check`: loops in operation, from files of a historian, from a folder of them, or from a request.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "api/batch/known_loops.h"
#include "api/batch/recorded_file.h"
#include "api/csv/time_stamp.h"
#include "api/historian/joined_loops.h"
#include "api/report/terminal/terminal.h"
#include "api/service.h"
#include "api/services/check_service.h"
#include "server/cli/command_tree.h"
#include "server/cli/interrupt.h"
#include "server/cli/output.h"
#include "server/clock.h"
#include "server/config.h"
#include "server/http/app/problems.h"
#include "server/threads/spare_cores.h"

namespace tunewright::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStandardInput = "-";

struct CheckCommand {
    std::vector<std::string> files;  ///< files and folders; "-": standard input
    std::string loops;               ///< a table with what is known of the loops; "": none
    std::string time_unit;           ///< of the files' times; "": the files' own
    std::string answer_unit;         ///< "": s
    bool settings = false;           ///< look for new settings where tuning is the cause
    OutputWords output;
};

/// A line on standard error that is written over, if that is a terminal.
class StatusLine {
public:
    ~StatusLine() { clear(); }

    void show(const std::string& sentence) {
        if (!terminal_) return;
        std::cerr << "\r\33[K" << sentence << std::flush;
        shown_ = true;
    }
    void clear() {
        if (std::exchange(shown_, false)) std::cerr << "\r\33[K" << std::flush;
    }

private:
    bool terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
};

/// The files of a folder that may hold records, in the order of their names.
std::vector<std::string> files_of_folder(const std::string& folder) {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file() && api::is_ending_of_records(entry.path().extension().string()))
            out.push_back(entry.path().string());
    }
    std::ranges::sort(out);
    return out;
}

api::Problem no_records(const std::string& folder) {
    return http::problem(422, "The folder " + folder + " has no file that ends in .csv, .tsv, .txt or .dat.");
}

/// All files that are named, those of folders included.
std::variant<std::vector<std::string>, api::Problem> all_files(const std::vector<std::string>& named) {
    std::vector<std::string> out;
    std::error_code unknown;
    for (const std::string& name : named) {
        if (name == kStandardInput || !fs::is_directory(name, unknown)) {
            out.push_back(name);
            continue;
        }
        std::vector<std::string> inside = files_of_folder(name);
        if (inside.empty()) return no_records(name);
        std::ranges::move(inside, std::back_inserter(out));
    }
    return out;
}

/// The bytes of a file or of standard input, in pieces.
class PieceReader {
public:
    explicit PieceReader(const std::string& file) {
        if (file == kStandardInput) {
            stream_ = &std::cin;
        } else if (std::error_code unknown; !fs::is_directory(file, unknown)) {
            file_.open(file, std::ios::binary);
            if (file_) stream_ = &file_;
        }
    }

    bool opened() const { return stream_ != nullptr; }
    /// The first byte that is not white space, a byte order mark or 0; 0 if the file has none.
    char first() {
        for (const char c : peeked_ = next())
            if (!std::isspace(static_cast<unsigned char>(c)) &&
                std::string_view("\xEF\xBB\xBF\xFF\xFE\0", 6).find(c) == std::string_view::npos)
                return c;
        return 0;
    }
    /// "" at the end.
    std::string_view next() {
        if (!peeked_.empty()) return std::exchange(peeked_, {});
        stream_->read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        return {buffer_.data(), static_cast<std::size_t>(stream_->gcount())};
    }

private:
    std::ifstream file_;
    std::istream* stream_ = nullptr;
    std::vector<char> buffer_ = std::vector<char>(1 << 18);
    std::string_view peeked_;
};

/// One check from its arguments to its answer.
class Check {
public:
    explicit Check(const CheckCommand& command) : command_(command) {}

    int run() {
        auto files = all_files(command_.files);
        if (const auto* problem = std::get_if<api::Problem>(&files)) return write_problem(*problem, command_.output);
        const auto& names = std::get<std::vector<std::string>>(files);
        if (auto problem = read_table()) return write_problem(*problem, command_.output, command_.loops);
        for (const std::string& name : names) {
            PieceReader pieces(name);
            if (!pieces.opened()) return write_problem(unreadable(name), command_.output);
            if (pieces.first() == '{') return names.size() == 1 ? check_requests(name, pieces) : refuse_mixture(name);
            read(name, pieces);
            if (interrupt_.stopped()) return stopped_while_reading();
        }
        if (const auto problem = loops_.finish())
            return write_problem(*problem, command_.output, names.size() == 1 ? names.front() : "");
        return answer(check([&](const RunControl& control) { return api::check_recorded(recorded(), control); }), "");
    }

private:
    std::optional<api::Problem> read_table() {
        if (command_.loops.empty()) return std::nullopt;
        PieceReader pieces(command_.loops);
        if (!pieces.opened()) return unreadable(command_.loops);
        std::string text;
        for (std::string_view piece = pieces.next(); !piece.empty(); piece = pieces.next()) text += piece;
        auto known = api::KnownLoops::read(text, answer_unit());
        if (auto* problem = std::get_if<api::Problem>(&known)) return std::move(*problem);
        known_ = std::get<api::KnownLoops>(std::move(known));
        return std::nullopt;
    }

    void read(const std::string& name, PieceReader& pieces) {
        status_.show("Reading " + name);
        api::RecordedFile file(options_for(name));
        std::optional<api::Problem> problem;
        for (std::string_view piece = pieces.next(); !piece.empty() && !problem; piece = pieces.next()) {
            if (interrupt_.stopped()) return;
            problem = file.feed(piece);
        }
        if (!problem) problem = file.finish();
        status_.clear();
        problem ? loops_.add_unreadable(name, *std::move(problem)) : loops_.add(name, file.loops());
    }

    /// All loops that were read, with what is known of them.
    api::RecordedLoops recorded() {
        api::RecordedLoops out;
        for (api::TaggedLoop loop; loops_.next(loop);) {
            const api::KnownLoop* known = known_.of(loop.tag);
            out.facts.push_back(known != nullptr ? known->facts : api::LoopFacts{});
            out.loops.push_back(std::move(loop));
        }
        out.notes = loops_.notes();
        if (std::string unused = known_.unused_note(); !unused.empty()) out.notes.push_back(std::move(unused));
        if (!command_.answer_unit.empty()) out.time_unit = command_.answer_unit;
        out.settings = command_.settings;
        return out;
    }

    std::string answer_unit() const { return command_.answer_unit.empty() ? "s" : command_.answer_unit; }

    api::LoopsOptions options_for(const std::string& name) const {
        api::LoopsOptions options;
        options.time_unit_given = !command_.answer_unit.empty();
        options.time_unit = answer_unit();
        options.file_time_unit = command_.time_unit;
        if (name != kStandardInput) options.set_file(name);
        options.max_numbers -= std::min(options.max_numbers, loops_.numbers());
        return options;
    }

    template <class Run>
    api::JobOutcome check(const Run& run) {
        SpareCores cores{core_count()};
        SpareCores::Computation computation{cores};
        RunControl control;
        control.stop = interrupt_.token();
        control.now_ms = monotonic_ms;
        control.spread = computation.spread();
        control.progress = [this](const Progress& progress) { status_.show(progress.message + " Ctrl-C stops here."); };
        api::JobOutcome outcome = run(control);
        status_.clear();
        return outcome;
    }

    int check_requests(const std::string& name, PieceReader& pieces) {
        if (!command_.loops.empty())
            return write_problem(
                http::problem(422, "--loops is for files of records; a request has these members in its loops."),
                command_.output, name);
        std::string text;
        for (std::string_view piece = pieces.next(); !piece.empty(); piece = pieces.next()) text += piece;
        const auto request = api::joined_requests(text);
        if (const auto* problem = std::get_if<api::Problem>(&request))
            return write_problem(*problem, command_.output, name);
        const auto prepared = api::prepare_job(std::get<std::string>(request));
        if (const auto* problem = std::get_if<api::Problem>(&prepared))
            return write_problem(*problem, command_.output, name);
        const auto& job = std::get<api::PreparedJob>(prepared);
        if (job.subject != api::JobSubject::check)
            return write_problem(http::problem(422,
                                               "This is not a request for a check: it has no loops. Use tunewright "
                                               "tune or range."),
                                 command_.output, name);
        return answer(check([&](const RunControl& control) { return api::run_job(job, control); }), name);
    }

    int refuse_mixture(const std::string& name) const {
        return write_problem(
            http::problem(422, name + " is a request in JSON; check it by itself, without other files."),
            command_.output);
    }

    int stopped_while_reading() {
        status_.clear();
        std::cerr << "tunewright: stopped while reading; no loop was checked.\n";
        return kInterrupted;
    }

    /// The answer, also of a check that was stopped.
    int answer(const api::JobOutcome& outcome, const std::string& name) const {
        if (!outcome.error_json.empty()) return write_problem(outcome.error_json, command_.output, name);
        if (outcome.result_json.empty()) {
            std::cerr << "tunewright: stopped; no loop was checked.\n";
            return kInterrupted;
        }
        const int written = write_answer(outcome.result_json, command_.output, api::check_text);
        return outcome.status == api::JobOutcome::Status::cancelled ? kInterrupted : written;
    }

    const CheckCommand& command_;
    Interrupt interrupt_;
    StatusLine status_;
    api::JoinedLoops loops_{api::seconds_per(answer_unit()).value_or(0)};
    api::KnownLoops known_;
};

/// "" for a unit of time, else what is wrong with it.
std::string unit_of_time(const std::string& unit) {
    return api::seconds_per(unit) ? "" : unit + " is no unit of time; give one such as ms, s, min or h.";
}

}  // namespace

void add_check_command(CommandTree& tree) {
    CheckCommand& checking = tree.keep<CheckCommand>();
    CLI::App& app = tree.add("check", "What is wrong with loops in operation, and what to do first",
                             [&] { return Check(checking).run(); });
    app.add_option("files", checking.files,
                   "Records of many loops or of one as CSV, folders of such files, or a request with loops as JSON; - "
                   "reads standard input")
        ->required();
    app.add_option("--loops", checking.loops,
                   "CSV with what is known of the loops: tag and any of kind, averaging, pv_low, pv_high, op_low, "
                   "op_high, weight, Kp, Ti, Td")
        ->type_name("FILE");
    app.add_option("--time-unit", checking.time_unit,
                   "Unit of the times of the files, if they give none or a wrong one")
        ->check(unit_of_time)
        ->type_name("UNIT");
    app.add_option("--answer-unit", checking.answer_unit, "Unit of the times of the answer; s if not given")
        ->type_name("UNIT");
    app.add_flag("--settings", checking.settings,
                 "Look for new settings where tuning is the cause: some seconds for each loop");
    add_output_options(app, checking.output, true);
}

}  // namespace tunewright::server
