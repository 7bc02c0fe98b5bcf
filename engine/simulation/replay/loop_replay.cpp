#include "engine/simulation/replay/loop_replay.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/simulation/run/held_motion.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kMaxEscape = 1e3;          // ranges of the recorded y and r
constexpr double kInstantTolerance = 1e-9;  // of a row: nearer instants are one
constexpr double kMaxSubsteps = 50;         // of a row: y is a straight line in it

/// x' = A x + B (u_new - u)(t - L) from row to row; a row is cut where its input changes.
class PlantDifference {
public:
    PlantDifference(const LinearPlant& plant, double delay, double h)
        : motion_(plant, 1.0, false),
          whole_(static_cast<long>(std::floor(delay / h + kInstantTolerance))),
          x_(static_cast<Index>(motion_.states()), 0.0) {
        double rest = std::max(0.0, delay - static_cast<double>(whole_) * h);
        if (rest <= kInstantTolerance * h) rest = 0;
        if (rest > 0) before_ = motion_.step(rest);
        after_ = motion_.step(h - rest);
    }

    /// The difference of y at row k, before the input changes there.
    double output(long k) const { return motion_.value(x_, arriving(k - 1)); }
    void give(double difference) { given_.push_back(difference); }
    /// From row k to row k + 1.
    void advance(long k) {
        if (before_) motion_.advance(*before_, arriving(k - 1), x_);
        motion_.advance(after_, arriving(k), x_);
    }

private:
    double arriving(long k) const {
        const long from = k - whole_;
        return from < 0 ? 0 : given_[static_cast<Index>(from)];
    }

    HeldMotion motion_;
    long whole_;
    std::optional<HeldStep> before_;
    HeldStep after_;
    std::vector<double> x_;
    std::vector<double> given_;
};

/// Runs the program between two rows: when it computes, and the y that it reads.
class ProgramClock {
public:
    ProgramClock(SampledPid law, const ProgramLimits& limits, double h)
        : h_(h),
          substeps_(static_cast<int>(std::clamp(std::ceil(h / law.Ts - kInstantTolerance), 1.0, kMaxSubsteps))),
          Ts_(law.Ts < h ? h / substeps_ : law.Ts),
          program_(with_sample_time(law, Ts_), limits) {}

    void take_over(double r, double y, double u) {
        program_.take_over(r, y, u);
        u_ = program_.step(r, y);
        y_ = y;
        r_ = r;
        next_ = Ts_;
    }
    /// At row k > 0.
    double at_row(long k, double r, double y) {
        if (Ts_ > h_ * (1 + kInstantTolerance)) {
            if (static_cast<double>(k) * h_ >= next_ - kInstantTolerance * h_) {
                u_ = program_.step(r, y);
                next_ += Ts_;
            }
        } else {
            for (int j = 1; j <= substeps_; ++j)
                u_ = program_.step(j < substeps_ ? r_ : r, y_ + (y - y_) * j / substeps_);
        }
        y_ = y;
        r_ = r;
        return u_;
    }
    double output() const { return u_; }

private:
    static SampledPid with_sample_time(SampledPid law, double Ts) {
        law.Ts = Ts;
        return law;
    }

    double h_;
    int substeps_;
    double Ts_;
    PidProgram program_;
    double u_ = 0, y_ = 0, r_ = 0, next_ = 0;
};

double range_of(const LoopRows& record) {
    const auto [low, high] = std::ranges::minmax(record.y);
    const auto [r_low, r_high] = std::ranges::minmax(record.r);
    return std::max(high, r_high) - std::min(low, r_low);
}

}  // namespace

ReplayedRows replay(const LinearPlant& plant, const SampledPid& law, const ProgramLimits& limits,
                    const LoopRows& record) {
    PlantDifference plant_difference(plant, plant.dead_time() + law.computation_delay, record.h);
    ProgramClock clock(law, limits, record.h);
    const double farthest = kMaxEscape * range_of(record);
    ReplayedRows made;
    made.u.reserve(record.size());
    made.y.reserve(record.size());
    for (Index k = 0; k < record.size(); ++k) {
        const long row = static_cast<long>(k);
        const double moved = plant_difference.output(row), y = record.y[k] + moved;
        if (!(std::abs(moved) <= farthest)) {
            made.escaped = true;
            break;
        }
        if (k == 0) clock.take_over(record.r[0], record.y[0], record.u[0]);
        const double u = k == 0 ? clock.output() : clock.at_row(row, record.r[k], y);
        made.y.push_back(y);
        made.u.push_back(u);
        plant_difference.give(u - record.u[k]);
        plant_difference.advance(row);
    }
    return made;
}

}  // namespace tunewright
