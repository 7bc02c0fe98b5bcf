#include "engine/check/samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

/// The indices of the rows with a time, ascending in time; a later row of equal time replaces the earlier one.
std::vector<std::size_t> in_order(const Record& record) {
    std::vector<std::size_t> order;
    order.reserve(record.t.size());
    for (std::size_t i = 0; i < record.t.size(); ++i)
        if (std::isfinite(record.t[i])) order.push_back(i);
    const auto earlier = [&](std::size_t a, std::size_t b) { return record.t[a] < record.t[b]; };
    if (!std::ranges::is_sorted(order, earlier)) std::ranges::stable_sort(order, earlier);
    std::vector<std::size_t> kept;
    kept.reserve(order.size());
    for (const std::size_t i : order) {
        if (!kept.empty() && record.t[kept.back()] == record.t[i]) kept.pop_back();
        kept.push_back(i);
    }
    return kept;
}

double held(double value, double before) { return std::isfinite(value) ? value : before; }

double usual_step(const std::vector<double>& t) {
    if (t.size() < 2) return 0;
    std::vector<double> steps(t.size() - 1);
    for (std::size_t i = 1; i < t.size(); ++i) steps[i - 1] = t[i] - t[i - 1];
    return median(std::move(steps));
}

struct Part {
    std::size_t begin = 0, end = 0;
    double duration = 0;
};

/// The part of the rows, from one with both values on, that lasts longest without a long gap.
Part longest_part(const Rows& rows) {
    Part best, here;
    const auto close = [&](std::size_t end) {
        here.end = end;
        here.duration = end > here.begin ? rows.t[end - 1] - rows.t[here.begin] : 0;
        if (here.end > here.begin && (best.end == best.begin || here.duration > best.duration)) best = here;
    };
    std::size_t first = 0;
    while (first < rows.t.size() && !(std::isfinite(rows.y[first]) && std::isfinite(rows.u[first]))) ++first;
    here.begin = first;
    double measured = first < rows.t.size() ? rows.t[first] : 0;
    for (std::size_t i = first; i < rows.t.size(); ++i) {
        if (!rows.measured[i]) continue;
        if (rows.t[i] - measured > kLongestGap * rows.step) {
            std::size_t end = i;
            while (end > here.begin && !rows.measured[end - 1]) --end;
            close(end);
            here.begin = i;
        }
        measured = rows.t[i];
    }
    std::size_t end = rows.t.size();
    while (end > here.begin && !rows.measured[end - 1]) --end;
    close(end);
    return best;
}

}  // namespace

Rows rows_of(const Record& record) {
    Rows rows;
    const auto order = in_order(record);
    const std::size_t n = order.size();
    rows.t.reserve(n);
    rows.y.reserve(n);
    rows.u.reserve(n);
    rows.measured.reserve(n);
    double y = NAN, u = NAN, r = NAN;
    for (const std::size_t i : order) {
        rows.t.push_back(record.t[i]);
        rows.measured.push_back(std::isfinite(record.y[i]) ? 1 : 0);
        rows.moved.push_back(std::isfinite(record.u[i]) ? 1 : 0);
        rows.y.push_back(y = held(record.y[i], y));
        rows.u.push_back(u = held(record.u[i], u));
        if (!record.r.empty()) rows.r.push_back(r = held(record.r[i], r));
        if (!record.automatic.empty()) rows.automatic.push_back(record.automatic[i] ? 1 : 0);
    }
    if (std::ranges::none_of(rows.r, [](double value) { return std::isfinite(value); })) rows.r.clear();
    rows.step = usual_step(rows.t);
    return rows;
}

std::vector<double> Samples::error() const {
    std::vector<double> e(y.size());
    const double centre = mean(y);
    for (std::size_t i = 0; i < e.size(); ++i) e[i] = (r.empty() ? centre : r[i]) - y[i];
    return e;
}

Samples even_samples(const Rows& rows) {
    Samples out;
    const Part part = longest_part(rows);
    if (part.end <= part.begin || !(rows.step > 0)) return out;
    out.start = rows.t[part.begin];
    out.step = std::max(rows.step, part.duration / static_cast<double>(kMostSamples - 1));
    const auto count = static_cast<std::size_t>(std::floor(part.duration / out.step + 0.5)) + 1;
    const bool has_r = !rows.r.empty() && std::isfinite(rows.r[part.begin]);
    std::size_t row = part.begin;
    for (std::size_t i = 0; i < count; ++i) {
        // A row counts from half a step before its place: clocks jitter.
        const double now = out.time(i) + 0.5 * out.step;
        while (row + 1 < part.end && rows.t[row + 1] < now) ++row;
        out.y.push_back(rows.y[row]);
        out.u.push_back(rows.u[row]);
        if (has_r) out.r.push_back(rows.r[row]);
        out.moved.push_back(rows.moved[row]);
        if (!rows.automatic.empty()) out.automatic.push_back(rows.automatic[row]);
    }
    return out;
}

std::vector<EqualRun> equal_runs(std::span<const double> values) {
    std::vector<EqualRun> runs;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && values[i] == values[i - 1])
            ++runs.back().length;
        else
            runs.push_back({i, 1});
    }
    return runs;
}

std::vector<double> block_means(std::span<const double> values, std::size_t count) {
    if (count <= 1) return {values.begin(), values.end()};
    std::vector<double> means(values.size() / count);
    for (std::size_t i = 0; i < means.size(); ++i) means[i] = mean(values.subspan(i * count, count));
    return means;
}

}  // namespace tunewright::check
