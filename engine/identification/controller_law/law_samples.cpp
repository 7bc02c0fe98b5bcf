#include "engine/identification/controller_law/law_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/identification/record/record_rows.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr std::size_t kMaxRows = 10'000;  // half a second of search; today's settings are in the last ones
constexpr int kMinHeldSamples = 3;        // at an end of u's range: two rows there are chance
constexpr int kMinStillSamples = 8;       // without a move of u: rounding alone seldom makes more
constexpr std::size_t kMinMovesForPeriod = 12, kMaxMovesForPeriod = 1500;
// Moves that keep step: all but those that manual operation makes; evidence: the logarithm of the odds against chance.
constexpr double kMinShareInStep = 0.99, kMinEvidence = 20;
// In rows: where a period's moves may lie (stamps are rounded and jitter); the least period that is a staircase.
constexpr double kRowOfMoves = 1.05, kMinPeriod = 1.2;

LawRows rows_with_numbers(const Record& record) {
    LawRows rows;
    double last = -std::numeric_limits<double>::infinity();
    const std::size_t n = record.t.size();
    const bool newest_first = times_fall(record);
    for (std::size_t k = n - std::min(n, kMaxRows); k < n; ++k) {
        const std::size_t i = newest_first ? n - 1 - k : k;
        const bool set = record.r.empty() || std::isfinite(record.r[i]);
        if (!std::isfinite(record.t[i]) || !std::isfinite(record.u[i]) || !std::isfinite(record.y[i]) || !set) continue;
        if (record.t[i] <= last) continue;
        last = record.t[i];
        rows.t.push_back(record.t[i]);
        rows.u.push_back(record.u[i]);
        rows.y.push_back(record.y[i]);
        if (!record.r.empty()) rows.r.push_back(record.r[i]);
        rows.manual.push_back(!record.automatic.empty() && !record.automatic[i]);
    }
    return rows;
}

/// Share of the moves whose phase k/c lies within the best window of one row, and where that window begins.
struct InStep {
    double share = 0, phase = 0;
};

InStep in_step(const std::vector<double>& moves, double c) {
    std::vector<double> phase;
    for (const double k : moves) phase.push_back(k / c - std::floor(k / c));
    std::ranges::sort(phase);
    const std::size_t n = phase.size();
    const double window = kRowOfMoves / c;
    InStep best;
    for (std::size_t from = 0, to = 0; from < n; ++from) {
        while (to < from + n && (to < n ? phase[to] : phase[to - n] + 1) - phase[from] < window) ++to;
        const double share = static_cast<double>(to - from) / static_cast<double>(n);
        if (share > best.share) best = {share, phase[from]};
    }
    // A controller moves u once a sample: a second move in the same period is out of step.
    double last = -1, second = 0;
    for (const double k : moves) {
        const double sample = std::floor(k / c - best.phase + 1e-9);
        second += sample == last;
        last = sample;
    }
    best.share -= second / static_cast<double>(n);
    return best;
}

/// The controller's period in rows and the first row of it; 1 where u may move with every row.
struct Staircase {
    double period = 1, first = 0;
};

/// The periods between `low` and `high` with which nearly all moves keep step: the highest such stretch of them.
std::optional<std::array<double, 2>> periods_in_step(const std::vector<double>& moves, double low, double high,
                                                     double fine) {
    std::optional<std::array<double, 2>> found;
    for (double c = high; c >= low; c -= fine * c) {
        if (in_step(moves, c).share >= kMinShareInStep)
            found = std::array{c, found ? (*found)[1] : c};
        else if (found)
            break;
    }
    return found;
}

Staircase staircase_of(const LawRows& rows) {
    std::vector<double> moves, apart;
    for (std::size_t i = 1; i < rows.u.size() && moves.size() < kMaxMovesForPeriod; ++i)
        if (rows.u[i] != rows.u[i - 1] && !rows.manual[i]) moves.push_back(static_cast<double>(i));
    if (moves.size() < kMinMovesForPeriod) return {};
    for (std::size_t i = 1; i < moves.size(); ++i) apart.push_back(moves[i] - moves[i - 1]);
    std::ranges::sort(apart);
    const double least = apart[apart.size() / 50];
    double low = std::max(kMinPeriod, least - 0.01), high = least + 0.98;
    // The first moves give the period coarsely and quickly; three times as many narrow it, until all are in.
    for (std::size_t count = std::min<std::size_t>(40, moves.size());; count = std::min(moves.size(), 3 * count)) {
        const std::vector<double> part(moves.begin(), moves.begin() + static_cast<long>(count));
        const double fine = 0.04 / (part.back() - part.front());  // of a row over the whole part
        const auto found = periods_in_step(part, low, high, fine);
        if (!found) return {};
        const double margin = 2 * fine * high;
        low = std::max(kMinPeriod, (*found)[0] - margin);
        high = (*found)[1] + margin;
        if (count == moves.size()) break;
    }
    const double middle = 0.5 * (low + high), whole = std::round(middle);
    const double period = whole > 1 && whole >= low && whole <= high ? whole : middle;
    const InStep step = in_step(moves, period);
    const double odds = static_cast<double>(moves.size()) * std::log(period / kRowOfMoves);
    if (odds < kMinEvidence || step.share < kMinShareInStep - 0.005) return {};
    return {period, step.phase * period};
}

void take(LawSamples& out, const LawRows& rows, std::size_t i, double t) {
    out.t.push_back(t);
    out.u.push_back(rows.u[i]);
    out.y.push_back(rows.y[i]);
    if (!rows.r.empty()) out.r.push_back(rows.r[i]);
    out.row.push_back(static_cast<int>(i));
    out.excluded.push_back(rows.manual[i]);
}

void leave_ends_out(LawSamples& s) {
    const std::size_t n = s.u.size();
    s.limited.assign(n, 0);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < n; ++i)
        if (!s.excluded[i]) low = std::min(low, s.u[i]), high = std::max(high, s.u[i]);
    for (const double end : {low, high}) {
        std::size_t longest = 0;
        for (std::size_t i = 0; i < n;) {
            std::size_t to = i;
            while (to < n && s.u[to] == end && !s.excluded[to]) ++to;
            longest = std::max(longest, to - i);
            i = std::max(to, i + 1);
        }
        if (longest < kMinHeldSamples) continue;
        for (std::size_t i = 0; i < n; ++i)
            if (s.u[i] == end && !s.excluded[i]) s.limited[i] = 1;
    }
}

void mark_still_stretches(LawSamples& s) {
    const std::size_t n = s.u.size();
    for (std::size_t i = 0; i < n;) {
        std::size_t to = i + 1;
        while (to < n && s.u[to] == s.u[i]) ++to;
        if (to - i >= kMinStillSamples)
            std::fill(s.still.begin() + static_cast<long>(i), s.still.begin() + static_cast<long>(to), 1);
        i = to;
    }
}

/// The mean of the usual spacings: a clock that rounds its stamps has no other that is right.
double row_time_of(const std::vector<double>& t) {
    std::vector<double> apart(t.size() - 1);
    for (std::size_t i = 1; i < t.size(); ++i) apart[i - 1] = t[i] - t[i - 1];
    const double usual = median(apart);
    double sum = 0, number = 0;
    for (const double spacing : apart)
        if (spacing > 0.5 * usual && spacing < 1.5 * usual) sum += spacing, ++number;
    return number > 0 ? sum / number : usual;
}

LawSamples sampled(LawRows rows, const Staircase& stairs) {
    LawSamples out;
    if (rows.t.size() < 2) return out;
    const double row_time = row_time_of(rows.t);
    if (stairs.period <= 1) {
        for (std::size_t i = 0; i < rows.t.size(); ++i) take(out, rows, i, rows.t[i]);
    } else {
        for (double at = stairs.first; at < static_cast<double>(rows.t.size()); at += stairs.period) {
            const auto i = static_cast<std::size_t>(std::max(0.0, std::ceil(at - 1e-6)));
            if (i >= rows.t.size()) break;
            take(out, rows, i, rows.t.front() + at * row_time);
        }
    }
    out.rows_y = std::move(rows.y);
    out.rows_r = std::move(rows.r);
    out.rows_per_sample = stairs.period;
    out.period = row_time * stairs.period;
    for (const char m : out.excluded) out.manual_rows += m;
    out.still.assign(out.u.size(), 0);
    if (out.size() > 0) leave_ends_out(out);
    return out;
}

}  // namespace

double rounding_step(std::vector<double> values) {
    std::ranges::sort(values);
    const double span = values.empty() ? 0 : values.back() - values.front();
    const double same = 1e-9 * std::max(span, 1e-3 * std::abs(values.empty() ? 0 : values.back()));
    std::vector<double> gaps;
    for (std::size_t i = 1; i < values.size(); ++i)
        if (values[i] - values[i - 1] > same) gaps.push_back(values[i] - values[i - 1]);
    if (gaps.size() < 3) return 0;
    // Values that were rounded before, on another grid, may lie two or three steps apart at least.
    for (const double parts : {1.0, 2.0, 3.0}) {
        const double step = *std::ranges::min_element(gaps) / parts;
        const auto on_grid = std::ranges::count_if(gaps, [&](double gap) {
            return std::abs(gap / step - std::round(gap / step)) < 0.02 * std::max(1.0, gap / step * 0.01);
        });
        if (static_cast<double>(on_grid) >= 0.99 * static_cast<double>(gaps.size())) return step;
    }
    return 0;
}

LawSamples each_row(LawRows rows) { return sampled(std::move(rows), {}); }

LawSamples law_samples(const Record& record) {
    LawRows rows = rows_with_numbers(record);
    const Staircase stairs = staircase_of(rows);
    LawSamples out = sampled(std::move(rows), stairs);
    out.u_step = rounding_step(out.u);
    out.y_step = rounding_step(out.y);
    if (record.automatic.empty()) mark_still_stretches(out);
    return out;
}

}  // namespace tunewright
