#include "engine/identification/record/clean_record.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "engine/identification/record/false_readings.h"
#include "engine/identification/record/record_rows.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

Error not_identifiable(std::string where, std::string message) {
    return {ErrorKind::not_identifiable, std::move(where), std::move(message)};
}

std::optional<Error> check_columns(const Record& r) {
    if (r.u.size() != r.t.size() || r.y.size() != r.t.size()) {
        return Error{ErrorKind::invalid_argument, "record",
                     "t, u and y have " + std::to_string(r.t.size()) + ", " + std::to_string(r.u.size()) + " and " +
                         std::to_string(r.y.size()) + " values; give columns of equal length."};
    }
    if (r.d.size() > static_cast<std::size_t>(kMaxFurtherInputs)) {
        return Error{ErrorKind::invalid_argument, "record/d",
                     "d has " + std::to_string(r.d.size()) + " further inputs; at most " +
                         std::to_string(kMaxFurtherInputs) + " can be identified together. Omit some."};
    }
    for (const FurtherInput& input : r.d) {
        if (input.values.size() == r.t.size()) continue;
        return Error{ErrorKind::invalid_argument, "record/d",
                     "The further input \"" + input.name + "\" has " + std::to_string(input.values.size()) +
                         " values and t " + std::to_string(r.t.size()) + "; give columns of equal length."};
    }
    if (r.u0 && !std::isfinite(*r.u0))
        return Error{ErrorKind::invalid_argument, "record/u0", "u0 must be a finite number."};
    if (r.y0 && !std::isfinite(*r.y0))
        return Error{ErrorKind::invalid_argument, "record/y0", "y0 must be a finite number."};
    return std::nullopt;
}

std::optional<Error> check_rows(const Record& r, const RecordRows& rows, const Cleaning& done) {
    const int n = static_cast<int>(rows.t.size());
    constexpr double kFewBackward = 0.1;  // of the rows: with more, the file contains several records, or none
    if (done.backward > kFewBackward * static_cast<double>(r.t.size())) {
        return Error{ErrorKind::invalid_argument, "record/t",
                     "Times run backward in " + std::to_string(done.backward) + " of " + std::to_string(r.t.size()) +
                         " rows (first at " + row_text(done, done.first_backward) +
                         "); sort the record by time, or give only one test."};
    }
    if (n < kMinSamples) {
        return not_identifiable(
            "record", "The record has " + std::to_string(n) + " usable samples" +
                          (r.t.size() > static_cast<std::size_t>(n)
                               ? " in " + std::to_string(r.t.size()) + " rows (the others have no y, no u or no time)"
                               : std::string()) +
                          "; at least " + std::to_string(kMinSamples) +
                          " are needed, and at least 50 during the response are recommended.");
    }
    if (rows.t.back() <= rows.t.front())
        return not_identifiable("record/t", "All samples have the same time; record the test with its time stamps.");
    const auto [y_low, y_high] = std::minmax_element(rows.y.begin(), rows.y.end());
    if (rows.change_time.empty()) {
        return not_identifiable(
            "record/u", "u never moves (it is " + text(rows.u_rest) + " in all " + std::to_string(n) +
                            " samples), so its effect cannot be identified. Record a test in which u changes, or give "
                            "u0 if u was changed just before the first sample.");
    }
    if (*y_low == *y_high) {
        return not_identifiable(
            "record/y",
            "y never moves (it is " + text(*y_low) + " in all " + std::to_string(n) +
                " samples). Make a larger step, record for longer, or check that this is the right sensor.");
    }
    return std::nullopt;
}

void scale_rows(const RecordRows& rows, CleanRecord& clean) {
    RecordScale& s = clean.scale;
    const auto [y_low, y_high] = std::minmax_element(rows.y.begin(), rows.y.end());
    const double origin = std::min(rows.t.front(), rows.change_time.front());
    s.t_origin = origin;
    s.t_scale = rows.t.back() - origin;
    s.y_origin = *y_low;
    s.y_scale = *y_high - *y_low;
    s.u_rest = rows.u_rest;
    s.u_scale = 0;
    for (double u : rows.change_level) s.u_scale = std::max(s.u_scale, std::abs(u - s.u_rest));
    clean.row = rows.number;
    clean.t.reserve(rows.t.size());
    clean.y.reserve(rows.y.size());
    for (std::size_t i = 0; i < rows.t.size(); ++i) {
        clean.t.push_back((rows.t[i] - s.t_origin) / s.t_scale);
        clean.y.push_back((rows.y[i] - s.y_origin) / s.y_scale);
    }
    for (std::size_t j = 0; j < rows.change_time.size(); ++j) {
        clean.v_time.push_back((rows.change_time[j] - s.t_origin) / s.t_scale);
        clean.v_level.push_back((rows.change_level[j] - s.u_rest) / s.u_scale);
    }
}

/// Empty if the input never moves.
std::optional<FurtherSteps> further_steps(const std::vector<double>& t, const FurtherInput& input,
                                          const RecordScale& s) {
    std::vector<std::pair<double, double>> known;
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (std::isfinite(t[i]) && std::isfinite(input.values[i])) known.emplace_back(t[i], input.values[i]);
    }
    if (known.empty()) return std::nullopt;
    std::stable_sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const double rest = known.front().second;
    FurtherSteps steps{input.name, {}, {}, 0};
    for (const auto& [time, value] : known) steps.scale = std::max(steps.scale, std::abs(value - rest));
    if (!(steps.scale > 0) || !std::isfinite(steps.scale)) return std::nullopt;
    double now = 0;
    for (const auto& [time, value] : known) {
        const double at = std::max(0.0, (time - s.t_origin) / s.t_scale), level = (value - rest) / steps.scale;
        if (level == now) continue;
        now = level;
        if (!steps.time.empty() && !(at > steps.time.back())) {
            steps.level.back() = level;
            continue;
        }
        steps.time.push_back(at);
        steps.level.push_back(level);
    }
    return steps;
}

/// A record with the same input and facts, without samples, which are most of a long record.
CleanRecord without_all_samples(const CleanRecord& record) {
    return {record, {}, {}, {}, record.v_time, record.v_level, record.v_open, record.d, record.v_recorded};
}

/// The mean of v over `blocks` blocks of equal length.
void average_input(const CleanRecord& from, int blocks, CleanRecord& to) {
    to.v_time.clear();
    to.v_level.clear();
    to.v_open.clear();
    std::size_t j = 0;
    double v = 0;
    for (int b = 0; b < blocks; ++b) {
        double now = static_cast<double>(b) / blocks;
        const double start = now, end = static_cast<double>(b + 1) / blocks;
        double area = 0;
        for (; j < from.v_time.size() && from.v_time[j] < end; ++j) {
            area += v * (from.v_time[j] - now);
            now = from.v_time[j];
            v = from.v_level[j];
        }
        area += v * (end - now);
        to.v_time.push_back(start);
        to.v_level.push_back(area / (end - start));
    }
}

/// The indices of the samples nearest in time after the few largest changes of v, spaced geometrically.
void add_transients(const CleanRecord& r, int each, std::vector<int>& chosen) {
    constexpr int kMaxChanges = 4;
    std::vector<int> order(r.v_time.size());
    std::iota(order.begin(), order.end(), 0);
    auto size = [&](int j) { return std::abs(r.v_level[j] - (j > 0 ? r.v_level[j - 1] : 0)); };
    const int kept = std::min<int>(kMaxChanges, static_cast<int>(order.size()));
    std::partial_sort(order.begin(), order.begin() + kept, order.end(),
                      [&](int a, int b) { return size(a) > size(b) || (size(a) == size(b) && a < b); });
    for (int k = 0; k < kept; ++k) {
        const int first = static_cast<int>(std::lower_bound(r.t.begin(), r.t.end(), r.v_time[order[k]]) - r.t.begin());
        const int left = r.samples() - first;
        if (left < 2) continue;
        for (int i = 0; i < each; ++i) chosen.push_back(first + static_cast<int>(std::pow(left, (i + 0.5) / each)) - 1);
    }
}

}  // namespace

std::string row_text(const Cleaning& cleaning, int row) {
    return (cleaning.from_file ? "line " : "row ") + std::to_string(row);
}

Expected<CleanRecord> clean_record(const Record& record) {
    if (auto error = check_columns(record)) return *error;
    CleanRecord clean;
    RecordRows rows = collect_rows(record, clean.cleaning);
    drop_false_readings(rows, record.u0.has_value(), clean.cleaning);
    drop_late_moves(rows, clean.cleaning);
    if (auto error = check_rows(record, rows, clean.cleaning)) return *error;
    const Cleaning& done = clean.cleaning;
    clean.u_only = done.missing_y + static_cast<int>(done.spikes.size());
    clean.dropped = clean.u_only + done.without_time + done.unread + done.silent + done.backward + done.early_stamps;
    scale_rows(rows, clean);
    const RecordScale& s = clean.scale;
    if (!std::isfinite(s.t_scale) || !std::isfinite(s.y_scale) || !std::isfinite(s.u_scale) || s.t_scale <= 0 ||
        s.y_scale <= 0 || s.u_scale <= 0) {
        return Error{ErrorKind::invalid_argument, "record",
                     "The range of the record's numbers exceeds double precision; give it in other units."};
    }
    clean.kind = record.kind;
    clean.u0_given = record.u0.has_value();
    for (const FurtherInput& input : record.d) {
        if (auto steps = further_steps(record.t, input, s)) clean.d.push_back(std::move(*steps));
    }
    if (record.y0) clean.y_rest = (*record.y0 - s.y_origin) / s.y_scale;
    return clean;
}

CleanRecord without_samples(CleanRecord record, const std::vector<std::size_t>& indices) {
    std::size_t next = 0, kept = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        if (next < indices.size() && indices[next] == i) {
            record.cleaning.spikes.push_back(record.row[i]);
            record.cleaning.spike_times.push_back(record.scale.t_origin + record.scale.t_scale * record.t[i]);
            ++next;
            continue;
        }
        record.t[kept] = record.t[i];
        record.y[kept] = record.y[i];
        record.row[kept] = record.row[i];
        ++kept;
    }
    record.t.resize(kept);
    record.y.resize(kept);
    record.row.resize(kept);
    record.u_only += static_cast<int>(next);
    record.dropped += static_cast<int>(next);
    return record;
}

std::vector<double> spacings(const CleanRecord& r) {
    std::vector<double> all;
    for (std::size_t i = 1; i < r.t.size(); ++i) {
        if (r.t[i] > r.t[i - 1]) all.push_back(r.t[i] - r.t[i - 1]);
    }
    return all;
}

double usual_spacing(const CleanRecord& r) {
    std::vector<double> all = spacings(r);
    return all.empty() ? 0 : median(std::move(all));
}

bool unevenly_spaced(const CleanRecord& record) {
    const double usual = usual_spacing(record);
    std::size_t off = 0;
    for (std::size_t i = 1; i < record.t.size(); ++i)
        off += std::abs(record.t[i] - record.t[i - 1] - usual) > kOffSpacing * usual ? 1 : 0;
    return 5 * off > record.t.size() - 1;
}

CleanRecord thin_out(const CleanRecord& record, int max) {
    constexpr int kMaxBlocks = 400;
    const int n = record.samples();
    // If u keeps moving, the whole record is transient.
    if (n <= max || record.changes() > 4) {
        CleanRecord thin = every_few(record, max);
        if (record.changes() > kMaxBlocks) average_input(record, kMaxBlocks, thin);
        return thin;
    }
    CleanRecord thin = without_all_samples(record);
    std::vector<int> chosen = {0, n - 1};
    for (int i = 0; i < max / 2; ++i) chosen.push_back(static_cast<int>(static_cast<long long>(i) * n / (max / 2)));
    add_transients(record, max / 2 / std::clamp(record.changes(), 1, 4), chosen);
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (int i : chosen) {
        thin.t.push_back(record.t[i]);
        thin.y.push_back(record.y[i]);
    }
    return thin;
}

CleanRecord every_few(const CleanRecord& record, int max) {
    const int n = record.samples(), stride = (n + max - 1) / max;
    if (stride <= 1) return record;
    CleanRecord few = without_all_samples(record);
    // A constant stride, so that evenly spaced samples stay evenly spaced.
    for (int i = (n - 1) % stride; i < n; i += stride) {
        few.t.push_back(record.t[static_cast<std::size_t>(i)]);
        few.y.push_back(record.y[static_cast<std::size_t>(i)]);
    }
    return few;
}

CleanRecord first_part(const CleanRecord& record, double fraction) {
    CleanRecord part{record, {}, {}, {}, {}, {}, {}, record.d};
    part.scale.t_scale *= fraction;
    const auto take = [&](const std::vector<double>& times, const std::vector<double>& values, auto& to, auto& of) {
        const auto kept = std::upper_bound(times.begin(), times.end(), fraction) - times.begin();
        to.assign(times.begin(), times.begin() + kept);
        of.assign(values.begin(), values.begin() + kept);
        for (double& t : to) t /= fraction;
    };
    take(record.t, record.y, part.t, part.y);
    take(record.v_time, record.v_level, part.v_time, part.v_level);
    for (std::size_t k = 0; k < record.d.size(); ++k)
        take(record.d[k].time, record.d[k].level, part.d[k].time, part.d[k].level);
    return part;
}

CleanRecord block_means(const CleanRecord& record, int max) {
    const int n = record.samples(), block = (n + max - 1) / max;
    if (block <= 1) return record;
    CleanRecord means = without_all_samples(record);
    for (int i = 0; i < n; i += block) {
        const int end = std::min(n, i + block);
        means.t.push_back(std::accumulate(record.t.begin() + i, record.t.begin() + end, 0.0) / (end - i));
        means.y.push_back(std::accumulate(record.y.begin() + i, record.y.begin() + end, 0.0) / (end - i));
    }
    return means;
}

CleanRecord condensed(const CleanRecord& record, int max) {
    CleanRecord means = block_means(record, max);
    if (record.samples() > max && record.changes() > max) average_input(record, max, means);
    return means;
}

}  // namespace tunewright
