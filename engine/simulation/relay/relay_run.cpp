#include "engine/simulation/relay/relay_run.h"

#include <algorithm>
#include <cmath>

#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr std::int64_t kMaxSteps = 4'000'000;
constexpr std::size_t kMaxPending = 20'000;
constexpr int kMaxCrowdedSwitches = 50;
constexpr double kSimultaneousTolerance = 1e-14;  // of t: two switches within it are simultaneous
constexpr int kPolishSteps = 6;                   // Newton steps; each squares the error of the quintic
constexpr double kPolishTolerance = 1e-15;        // of the step: rounding
constexpr double kLevelTolerance = 1e-9;          // of a level: a length within it of a power of 2 is that power
constexpr int kMaxLevel = 59;
constexpr double kMaxLogGrowth = 45;  // e^45 beyond the last swing: y does not return
constexpr int kFirstSwitches = 4;
constexpr double kMaxSwingRatio = 1e9;    // multiple of the swing before these switches
constexpr double kMaxWaitInSteps = 1e12;  // multiple of the shortest step, for ramps

}  // namespace

double held_start(const LinearPlant& plant, const RelayLevels& levels) {
    if (plant.dead_time() > 0 || levels.hysteresis > 0) return 0;
    return plant.time_scale() / 2;
}

RelayRun::RelayRun(RelayMotion& motion, double dead_time, const RelayLevels& levels, double held)
    : RelayRun(motion, dead_time, levels,
               {std::vector<double>(static_cast<std::size_t>(motion.states()), 0.0),
                0,
                levels.u_plus,
                {{dead_time, levels.u_plus}}}) {
    held_ = held;
}

RelayRun::RelayRun(RelayMotion& motion, double dead_time, const RelayLevels& levels, RelayState start)
    : motion_(&motion),
      L_(dead_time),
      levels_(levels),
      x_(std::move(start.x)),
      x_rise_(x_),
      v_(start.v),
      u_(start.u),
      pending_(std::move(start.pending)) {}

double RelayRun::excess(double y) const {
    return u_ == levels_.u_plus ? y - levels_.hysteresis : -levels_.hysteresis - y;
}

void RelayRun::take_pending() {
    while (!pending_.empty() && pending_.front().t <= t_) {
        v_ = pending_.front().v;
        pending_.pop_front();
        changed_at_ = t_;
        if (v_ == levels_.u_plus) x_rise_ = x_;
    }
}

RelayPiece RelayRun::switch_over(RelayPiece piece) {
    piece.switched = true;
    piece.t_end = t_;
    ++switches_;
    crowded_ = t_ - switched_at_ <= kSimultaneousTolerance * t_ ? crowded_ + 1 : 0;
    if (crowded_ > kMaxCrowdedSwitches) end_ = RelayEnd::too_fast;
    switched_at_ = t_;
    u_ = u_ == levels_.u_plus ? levels_.u_minus : levels_.u_plus;
    pending_.push_back({t_ + L_, u_});
    if (pending_.size() > kMaxPending) end_ = RelayEnd::too_fast;
    return piece;
}

bool RelayRun::settle_or_escape(bool quiet, double elapsed, double slope) {
    if (!pending_.empty()) return false;
    const double outward = u_ == levels_.u_plus ? slope : -slope;
    const int integrators = motion_->integrators();
    if (motion_->growth_rate() * elapsed > kMaxLogGrowth) {
        end_ = RelayEnd::escaped;
    } else if ((quiet && (integrators <= 0 || (integrators == 1 && outward <= 0))) ||
               elapsed > kMaxWaitInSteps * motion_->shortest()) {
        end_ = RelayEnd::latched;
    }
    return end_ != RelayEnd::running;
}

// The first time in the step at which the excess becomes positive; `first` is the excess at its start.
std::optional<double> RelayRun::crossing(const Quintic& y, double first) const {
    const double h = y.length();
    const double outward = u_ == levels_.u_plus ? 1 : -1;
    double high = h;
    if (!(excess(y.at(h)) > 0)) {
        const auto top = y.extremum();
        if (!top || !(outward * y.slope(0) > 0) || !(excess(y.at(*top)) > 0)) return std::nullopt;
        high = *top;
    }
    double low = 0;
    if (first >= 0 && outward * y.slope(0) < 0) {
        // It starts at the threshold, moves inward and returns.
        if (const auto bottom = y.extremum()) low = *bottom;
    } else if (first >= 0) {
        return 0;
    }
    const auto beyond = [&](double tau) { return excess(y.at(tau)); };
    return polish(first_positive(beyond, low, high, beyond(low), beyond(high)), low, high);
}

// Newton steps on the exact motion.
double RelayRun::polish(double tau, double low, double high) const {
    const double outward = u_ == levels_.u_plus ? 1 : -1;
    for (int i = 0; i < kPolishSteps; ++i) {
        std::vector<double> x = x_;
        motion_->advance(motion_->step(tau), v_, x);
        const OutputMotion there = motion_->output(x, v_);
        const double slope = outward * there.slope;
        if (!(slope > 0)) break;
        const double next = tau - excess(there.y) / slope;
        if (!(next >= low && next <= high)) break;
        const double change = std::abs(next - tau);
        tau = next;
        if (change <= kPolishTolerance * high) break;
    }
    return tau;
}

std::optional<RelayPiece> RelayRun::next() {
    if (end_ != RelayEnd::running) return std::nullopt;
    if (++steps_ > kMaxSteps) {
        end_ = RelayEnd::exhausted;
        return std::nullopt;
    }
    take_pending();
    const OutputMotion now = motion_->output(x_, v_);
    RelayPiece piece{t_, 0, t_, u_, false, Quintic(0, now, now)};
    double first = excess(now.y);
    // Without a direct term y is continuous, so every crossing was found inside a step: a remaining excess is rounding.
    if (motion_->direct_term() == 0) first = std::min(first, 0.0);
    if (first > 0 && t_ >= held_) return switch_over(piece);

    bool quiet = false;
    const double elapsed = t_ - changed_at_;
    const double allowed = motion_->states() == 0 ? motion_->shortest() : motion_->spacing(elapsed, quiet);
    if (motion_->states() == 0) quiet = true;
    if (settle_or_escape(quiet, elapsed, now.slope)) return std::nullopt;

    const int k =
        std::clamp(static_cast<int>(std::log2(allowed / motion_->shortest()) + kLevelTolerance), 0, kMaxLevel);
    double h = std::ldexp(motion_->shortest(), k);
    const bool to_pending = !pending_.empty() && (motion_->states() == 0 || t_ + h >= pending_.front().t);
    if (to_pending) h = pending_.front().t - t_;

    std::vector<double> x = x_;
    if (to_pending)
        motion_->advance(motion_->step(h), v_, x);
    else
        motion_->advance(motion_->level(k), v_, x);
    const OutputMotion then = motion_->output(x, v_);
    piece.y = Quintic(h, now, then);
    if (switches_ < kFirstSwitches) swing_ = std::max(swing_, std::abs(then.y));
    if (!std::isfinite(then.y) || (switches_ >= kFirstSwitches && std::abs(then.y) > kMaxSwingRatio * swing_)) {
        end_ = RelayEnd::escaped;
        return std::nullopt;
    }
    if (const auto tau = t_ < held_ ? std::nullopt : crossing(piece.y, first)) {
        motion_->advance(motion_->step(*tau), v_, x_);
        piece.h = *tau;
        t_ += *tau;
        return switch_over(piece);
    }
    x_ = std::move(x);
    t_ = to_pending ? pending_.front().t : t_ + h;
    piece.h = h;
    piece.t_end = t_;
    return piece;
}

}  // namespace tunewright
