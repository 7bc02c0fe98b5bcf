#include "tests/records/made_record.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace tunewright::records {
namespace {

void keep_rows(Record& record, const std::function<bool(std::size_t)>& kept) {
    std::vector<std::vector<double>*> columns = {&record.t, &record.u, &record.y, &record.r};
    for (FurtherInput& input : record.d) columns.push_back(&input.values);
    std::size_t to = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        if (!kept(i)) continue;
        for (auto* column : columns) {
            if (!column->empty()) (*column)[to] = (*column)[i];
        }
        ++to;
    }
    for (auto* column : columns) {
        if (!column->empty()) column->resize(to);
    }
}

/// True if an input differs from the previous row, or there is none.
bool moves(const Record& record, std::size_t i) {
    if (i == 0 || record.u[i] != record.u[i - 1]) return true;
    for (const FurtherInput& input : record.d) {
        if (input.values[i] != input.values[i - 1]) return true;
    }
    return false;
}

}  // namespace

void log_rows(Noise noise, double noise_std, double size, Record& record, Random& random) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    switch (noise) {
        case Noise::outliers:
            for (double& y : record.y) {
                if (random.chance(0.004)) y += size * random.uniform(1, 6) * (random.chance(0.5) ? 1 : -1);
            }
            break;
        case Noise::missing_rows:
            for (double& y : record.y) {
                if (random.chance(0.04)) y = nan;
            }
            keep_rows(record, [&](std::size_t) { return !random.chance(0.05); });
            break;
        case Noise::irregular_times:
            // Random rows, and those in which an input has just moved.
            keep_rows(record, [&](std::size_t i) { return moves(record, i) || random.chance(0.6); });
            break;
        case Noise::logged_on_change: {
            const double band = size * std::max(0.004, noise_std);
            double last = record.y[0];
            std::size_t silent = 0;
            std::vector<bool> kept;
            for (std::size_t i = 0; i < record.t.size(); ++i) {
                const bool now = moves(record, i) || std::abs(record.y[i] - last) > band || ++silent >= 30;
                if (now) last = record.y[i], silent = 0;
                kept.push_back(now);
            }
            keep_rows(record, [&](std::size_t i) { return kept[i]; });
            break;
        }
        default: break;
    }
}

}  // namespace tunewright::records
