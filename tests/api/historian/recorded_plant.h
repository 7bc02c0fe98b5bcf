// Three loops of a plant, written in each layout of a historian.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/csv/text.h"
#include "api/historian/loops_reader.h"

namespace tunewright::api::recorded {

/// What a file gives: its loops and findings, or the reason why it is refused.
struct ReadFile {
    std::vector<TaggedLoop> loops;
    std::vector<std::string> notes;
    std::string refusal;
};

inline ReadFile read_file(const std::string& bytes, const LoopsOptions& options = {}) {
    ReadFile out;
    LoopsReader reader(options);
    std::string storage;
    const std::string_view text = utf8_text(bytes, storage);
    std::size_t at = 0;
    std::optional<Problem> problem;
    for (int number = 1; !problem; ++number) {
        const auto line = next_line(text, at);
        if (!line) break;
        problem = reader.line(number, *line);
    }
    if (!problem) problem = reader.finish();
    if (problem) out.refusal = problem->detail;
    TaggedLoop loop;
    while (!problem && reader.next(loop)) out.loops.push_back(loop);
    out.notes = reader.notes();
    return out;
}

inline const TaggedLoop& loop_of(const ReadFile& file, const std::string& tag) {
    static const TaggedLoop none;
    for (const TaggedLoop& loop : file.loops)
        if (loop.tag == tag) return loop;
    return none;
}

constexpr int kRows = 60, kStep = 10;  ///< rows, and seconds between them

inline const std::vector<std::string> kTags = {"FIC101", "TIC-102", "LIC103"};

/// The value of a part of a loop in a row, as written.
inline std::string value_at(std::size_t loop, std::string_view part, int row) {
    const int k = row + 7 * static_cast<int>(loop);
    if (part == "PV") return std::to_string(20 + k % 13) + "." + std::to_string(k % 10) + "5";
    if (part == "OP") return std::to_string(40 + k % 7) + ".5";
    if (part == "SP") return row < kRows / 2 ? "25" : "26.5";
    return row < kRows / 3 ? "MAN" : row < kRows / 2 ? "AUTO" : "CAS";
}

inline std::string stamp_at(int row) {
    const int seconds = row * kStep;
    const auto two = [](int n) { return (n < 10 ? "0" : "") + std::to_string(n); };
    return "2026-05-04T06:" + two(seconds / 60) + ":" + two(seconds % 60);
}

inline const std::vector<std::string> kParts = {"PV", "SP", "OP", "MODE"};

inline std::string wide_file() {
    std::string out = "Time";
    for (const std::string& tag : kTags)
        for (const std::string& part : kParts) out += "," + tag + "." + part;
    for (int row = 0; row < kRows; ++row) {
        out += "\n" + stamp_at(row);
        for (std::size_t loop = 0; loop < kTags.size(); ++loop)
            for (const std::string& part : kParts) out += "," + value_at(loop, part, row);
    }
    return out + "\n";
}

inline std::string long_file() {
    std::string out = "Timestamp,TagName,Value\n";
    for (int row = 0; row < kRows; ++row)
        for (std::size_t loop = 0; loop < kTags.size(); ++loop)
            for (const std::string& part : kParts)
                out += stamp_at(row) + "," + kTags[loop] + "." + part + "," + value_at(loop, part, row) + "\n";
    return out;
}

inline std::string rows_file() {
    std::string out = "Time,Tag,PV,SP,OP,Mode\n";
    for (int row = 0; row < kRows; ++row)
        for (std::size_t loop = 0; loop < kTags.size(); ++loop) {
            out += stamp_at(row) + "," + kTags[loop];
            for (const std::string& part : kParts) out += "," + value_at(loop, part, row);
            out += "\n";
        }
    return out;
}

/// All of a loop with absolute times, so that two readings can be compared.
inline std::string all_of(const TaggedLoop& loop) {
    std::string out = loop.tag + " " + loop.fault.value_or("") + " bad " + std::to_string(loop.bad) + "\n";
    for (std::size_t i = 0; i < loop.t.size(); ++i) {
        out += std::to_string(loop.t[i] + loop.epoch.value_or(0)) + " " + std::to_string(loop.y[i]) + " " +
               std::to_string(loop.u[i]);
        if (!loop.r.empty()) out += " " + std::to_string(loop.r[i]);
        if (!loop.mode.empty()) out += " " + loop.mode_words[loop.mode[i]];
        out += "\n";
    }
    return out;
}

inline std::string all_of(const ReadFile& file) {
    std::string out = file.refusal;
    for (const TaggedLoop& loop : file.loops) out += all_of(loop);
    return out;
}

}  // namespace tunewright::api::recorded
