#include "engine/identification/fit/between_rows.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "engine/identification/fit/record_repair.h"
#include "engine/identification/record/series.h"

namespace tunewright {
namespace {

/// What acts as dead time: an integrator's lags, else half of the lags but the slowest (Skogestad 2003, half rule).
double acting_dead_time(const ModelShape& shape) {
    const bool third = shape.structure == Structure::third;
    if (shape.structure == Structure::ipdt) return shape.L();
    const double lags = has_quadratic(shape.structure) ? shape.a1() + (third ? shape.T3() : 0) : shape.T();
    if (is_integrating(shape.structure)) return shape.L() + lags;
    if (shape.structure == Structure::unstable) return shape.L();
    return shape.L() + 0.5 * std::max(0.0, lags - shape.slowest_lag());
}

/// Whether the rows before the moves are such that each may lie anywhere between two of them.
bool seen_at_rows(const CleanRecord& r, double row) {
    constexpr int kMost = 5;                     // moves: more are a program's
    constexpr double kGap = 1.5, kApart = 2.99;  // rows
    if (r.row.empty() || r.changes() > kMost || r.moves_unseen > 0 || r.moves_placed > 0 || r.moved_between_rows)
        return false;
    if (unevenly_spaced(r)) return false;
    for (int j = 0; j < r.changes(); ++j) {
        const double late = r.v_time[j] - row_before(r, r.v_time[j]);
        if (!(late > 0) || late > kGap * row) return false;
        if (j > 0 && r.v_time[j] - r.v_time[j - 1] < kApart * row) return false;
    }
    return true;
}

/// Where several moves lie in their rows, as y shows it.
class MovesInRows {
public:
    MovesInRows(const CleanRecord& record, const Fit& fit, double row, const std::stop_token& stop)
        : record_(record), fit_(fit), row_(row), stop_(stop), early_(record.v_time.size(), 0.0) {
        least_ = on_rows_ = misfit(early_);
        samples_ = effective_samples(fit.residual);
    }

    /// y's misfit is plainly less with the moves off their rows; they are then placed.
    bool lie_apart() {
        constexpr int kParts = 4, kRounds = 2;
        constexpr double kPlainly = 6;  // difference of the criterion (Kass and Raftery 1995, section 3.2)
        for (int round = 0; round < kRounds; ++round) {
            for (double& early : early_) {
                double best = early;
                for (int k = 0; k <= kParts && !stop_.stop_requested(); ++k) {
                    early = row_ * k / kParts;
                    const double now = misfit(early_);
                    if (now < least_) least_ = now, best = early;
                }
                early = best;
            }
        }
        const double price = (static_cast<double>(early_.size()) - 1) * std::log(samples_);
        return gain(on_rows_, least_) > price + kPlainly;
    }

    /// Whether y would show any one of the moves that lay off its row by half of it.
    bool shown_on_rows() const {
        constexpr double kPlainly = 4;  // two standard errors
        for (std::size_t j = 0; j < early_.size(); ++j) {
            std::vector<double> early(early_.size(), 0.0);
            early[j] = 0.5 * row_;
            if (gain(misfit(early), on_rows_) < kPlainly) return false;
        }
        return true;
    }

    /// How much earlier each is than its row; the common part is open, and in the middle of what it may be.
    double centre(std::vector<double>& early) const {
        early = early_;
        const auto [least, most] = std::ranges::minmax(early);
        const double open = row_ - (most - least), shift = 0.5 * (row_ - (most + least));
        for (double& one : early) one += shift;
        return open;
    }

private:
    double misfit(const std::vector<double>& early) const {
        constexpr Effort kRough{20, 1e-6};
        CleanRecord moved = record_;
        for (std::size_t j = 0; j < early.size(); ++j) moved.v_time[j] -= early[j];
        return fit_shape({&moved, {}}, fit_.form, fit_.shape, kRough, stop_).sse;
    }
    double gain(double from, double to) const {
        return samples_ * std::log(std::max(from, kLeast) / std::max(to, kLeast));
    }

    static constexpr double kLeast = 1e-14;  // of y's range squared: rounding
    const CleanRecord& record_;
    const Fit& fit_;
    double row_;
    const std::stop_token& stop_;
    std::vector<double> early_;
    double on_rows_ = 0, least_ = 0, samples_ = 1;
};

}  // namespace

CleanRecord changed_between_rows(CleanRecord record) {
    for (double& time : record.v_time) {
        const auto row = std::lower_bound(record.t.begin(), record.t.end(), time);
        if (row != record.t.begin()) time = 0.5 * (time + *std::prev(row));
    }
    record.moved_between_rows = true;
    return record;
}

std::optional<CleanRecord> with_moves_between_rows(const CleanRecord& record, const Fit& fit,
                                                   const std::stop_token& stop) {
    constexpr double kSmall = 0.5;  // of the dead time that is seen
    const double row = usual_spacing(record);
    if (!(row > kSmall * acting_dead_time(fit.shape)) || !seen_at_rows(record, row)) return std::nullopt;
    CleanRecord moved = record;
    moved.moved_within = 2 * row;  // a row at most before the one that stands there
    if (record.changes() < 2) return moved;
    MovesInRows moves(record, fit, row, stop);
    if (moves.lie_apart()) {
        std::vector<double> early;
        moved.moved_within = moves.centre(early);
        for (std::size_t j = 0; j < early.size(); ++j)
            moved.v_time[j] = std::max(moved.v_time[j] - early[j], row_before(record, record.v_time[j]));
    } else if (moves.shown_on_rows()) {
        return std::nullopt;
    }
    return stop.stop_requested() ? std::nullopt : std::optional(std::move(moved));
}

}  // namespace tunewright
