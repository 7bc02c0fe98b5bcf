#include "api/csv/shape/runs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/number_text.h"

namespace tunewright::api {
namespace {

/// Rows [first, end) of a record; the first `countdown` of them count down.
struct RowRun {
    std::size_t first = 0, end = 0, countdown = 0;

    std::size_t rows() const { return end - first; }
};

constexpr std::size_t kShortest = 3;  // rows in the same direction

bool newest_first(const std::vector<double>& t) {
    std::size_t up = 0, down = 0;
    for (std::size_t i = 1; i < t.size(); ++i) {
        up += t[i] > t[i - 1] ? 1 : 0;
        down += t[i] < t[i - 1] ? 1 : 0;
    }
    return down > 9 * up && down > 2;
}

/// Number of consecutive rows from `i` on that count down.
std::size_t falling(const std::vector<double>& t, std::size_t i) {
    std::size_t end = i + 1;
    while (end < t.size() && t[end] < t[end - 1]) ++end;
    return end - i;
}

/// True if the times begin again at row i of a run that began at `first` and has come to `latest`: they fall by half of
/// the covered time and continue from there, and the row before is not the false one.
bool begins_again(const std::vector<double>& t, std::size_t first, std::size_t i, double latest) {
    if (i - first < 2) return false;
    const double covered = latest - t[first];
    if (!(latest - t[i] > 0.5 * covered)) return false;
    // A row far ahead of its neighbours is a false time.
    if (t[i - 2] <= t[i] && (i < first + 3 || t[i - 3] <= t[i])) return false;
    // A single row with an earlier time is a false time, too.
    return i + 1 < t.size() && t[i + 1] < latest;
}

std::vector<RowRun> runs_of(const std::vector<double>& t) {
    std::vector<RowRun> runs;
    RowRun run;
    std::size_t first = 0;  // row from which the run's times count up
    double latest = 0;
    const auto start = [&](std::size_t i) {
        run = {i, i, falling(t, i)};
        if (run.countdown < kShortest) run.countdown = 0;
        first = i + (run.countdown > 0 ? run.countdown - 1 : 0);
        latest = t[first];
        return first + 1;
    };
    std::size_t i = start(0);
    while (i < t.size()) {
        if (t[i] < t[i - 1] && begins_again(t, first, i, latest)) {
            run.end = i;
            runs.push_back(run);
            i = start(i);
            continue;
        }
        latest = std::max(latest, t[i++]);
    }
    run.end = t.size();
    runs.push_back(run);
    return runs;
}

/// Moves the rows that count down in front of those that count up, into the order of time.
void turn_countdown(CsvRecord& record, const RowRun& run) {
    if (run.countdown == 0) return;
    const std::size_t last = run.first + run.countdown - 1;
    const double end = record.t[last];
    for (std::size_t i = run.first; i < last; ++i) record.t[i] = 2 * end - record.t[i];
    record.notes.push_back("The times count down in the lines " + std::to_string(record.lines[run.first]) + " to " +
                           std::to_string(record.lines[last]) +
                           " and up afterwards: those lines were placed first, from t = " +
                           tunewright::text(record.t[run.first]) + " on.");
}

/// True if the rows that count up continue from those that count down.
bool contiguous(const std::vector<double>& t, const RowRun& run) {
    if (run.countdown == 0 || run.rows() == run.countdown) return true;
    constexpr double kMaxSpacings = 3;
    const std::size_t last = run.first + run.countdown - 1;
    const double step = t[last - 1] - t[last], next = t[last + 1] - t[last];
    return next >= 0 && next <= kMaxSpacings * step;
}

/// A countdown that does not lead to a test is a run of its own.
std::vector<RowRun> parted(const std::vector<double>& t, const std::vector<RowRun>& runs) {
    std::vector<RowRun> out;
    for (const RowRun& run : runs) {
        if (contiguous(t, run)) {
            out.push_back(run);
            continue;
        }
        const std::size_t up = run.first + run.countdown;
        out.push_back({run.first, up, run.countdown});
        out.push_back({up, run.end, 0});
    }
    return out;
}

/// Largest minus smallest number; negative if there is none.
double range_of(const std::vector<double>& values) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
        if (std::isnan(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    return high - low;
}

/// True if u moves in the run and y then moves too: by a twentieth of `range_y`, its range in the whole file.
bool tests_something(const CsvRecord& record, const RowRun& run, double range_y) {
    constexpr std::size_t kMinRunRows = 8;
    constexpr double kMinAnswerShare = 0.05;
    if (run.rows() < kMinRunRows) return false;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    bool moved = record.u_stepped;
    double u = std::nan("");
    for (std::size_t i = run.first; i < run.end; ++i) {
        if (!std::isnan(record.u[i])) {
            moved = moved || (!std::isnan(u) && record.u[i] != u);
            u = record.u[i];
        }
        if (!moved || std::isnan(record.y[i])) continue;
        low = std::min(low, record.y[i]);
        high = std::max(high, record.y[i]);
    }
    return moved && high - low > kMinAnswerShare * range_y;
}

void keep_rows(CsvRecord& record, const RowRun& run) {
    const auto keep = [&](auto& column) {
        if (column.empty()) return;
        column.erase(column.begin() + static_cast<std::ptrdiff_t>(run.end), column.end());
        column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(run.first));
    };
    keep(record.t);
    keep(record.u);
    keep(record.y);
    keep(record.r);
    keep(record.automatic);
    for (FurtherInput& input : record.d) keep(input.values);
    keep(record.lines);
}

std::string in_words(const CsvRun& run, std::size_t number) {
    return "run " + std::to_string(number) + ", lines " + std::to_string(run.first_line) + " to " +
           std::to_string(run.last_line) + " (" + std::to_string(run.rows) +
           " rows, t = " + tunewright::text(run.from) + " to " + tunewright::text(run.to) +
           (run.tests ? ")" : "; u does not move or y does not respond)");
}

void note_runs(CsvRecord& record, int taken, bool chosen) {
    constexpr std::size_t kMaxListed = 6;
    std::string others;
    std::size_t shown = 0;
    for (std::size_t k = 0; k < record.runs.size(); ++k) {
        if (static_cast<int>(k) + 1 == taken || ++shown > kMaxListed) continue;
        others += (others.empty() ? "" : "; ") + in_words(record.runs[k], k + 1);
    }
    if (shown > kMaxListed) others += "; and " + std::to_string(shown - kMaxListed) + " more";
    const std::string sentence =
        "The times start again: the file contains " + std::to_string(record.runs.size()) + " runs. Read is " +
        in_words(record.runs[static_cast<std::size_t>(taken) - 1], static_cast<std::size_t>(taken)) +
        (chosen ? ", as chosen" : ", the longest in which y responds to a move of u") + ". The others are " + others +
        ".";
    // A run that was not chosen is a warning: another one may be meant.
    if (chosen)
        record.notes.push_back(sentence);
    else
        record.unread += (record.unread.empty() ? "" : " ") + sentence;
}

}  // namespace

std::optional<CsvFault> take_run(CsvRecord& record, std::optional<int> chosen) {
    if (record.t.size() < 2) return std::nullopt;
    const std::vector<RowRun> runs =
        newest_first(record.t) ? std::vector<RowRun>{{0, record.t.size(), 0}} : parted(record.t, runs_of(record.t));
    if (runs.size() > kMaxFileRuns)
        return CsvFault{"csv", "The times start again " + std::to_string(runs.size() - 1) + " times; at most " +
                                   std::to_string(kMaxFileRuns) +
                                   " runs in one file are read. Sort the rows by time, choose another column of "
                                   "times, or export one test alone."};
    if (chosen && (*chosen < 1 || static_cast<std::size_t>(*chosen) > runs.size()))
        return CsvFault{"run", "run is " + std::to_string(*chosen) + "; the file holds " +
                                   (runs.size() == 1 ? "one run, whose times never start again. Leave run out."
                                                     : std::to_string(runs.size()) + " runs, counted from 1.")};
    if (runs.size() == 1) {
        turn_countdown(record, runs.front());
        return std::nullopt;
    }
    std::size_t taken = 0;
    const double range_y = range_of(record.y);
    for (std::size_t k = 0; k < runs.size(); ++k) {
        const auto [low, high] = std::minmax_element(record.t.begin() + static_cast<std::ptrdiff_t>(runs[k].first),
                                                     record.t.begin() + static_cast<std::ptrdiff_t>(runs[k].end));
        record.runs.push_back({record.lines[runs[k].first], record.lines[runs[k].end - 1],
                               static_cast<int>(runs[k].rows()), *low, *high,
                               tests_something(record, runs[k], range_y)});
        const CsvRun &best = record.runs[taken], &now = record.runs[k];
        if (now.tests > best.tests || (now.tests == best.tests && now.rows > best.rows)) taken = k;
    }
    if (chosen) taken = static_cast<std::size_t>(*chosen) - 1;
    record.run = static_cast<int>(taken) + 1;
    note_runs(record, record.run, chosen.has_value());
    turn_countdown(record, runs[taken]);
    keep_rows(record, runs[taken]);
    return std::nullopt;
}

}  // namespace tunewright::api
