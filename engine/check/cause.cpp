#include "engine/check/cause.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/check/oscillation/peak_search.h"
#include "engine/check/pace/loop_speed.h"
#include "engine/check/pace/set_point_response.h"
#include "engine/check/thresholds.h"
#include "engine/check/valve/hysteresis.h"
#include "engine/check/valve/valve_fit.h"
#include "engine/identification/record/series.h"
#include "engine/number_text.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr double kSettling = 0.05;     // of the record: left out of the oscillation, for the start of a cycle
constexpr double kSamePeriod = 0.1;    // relative: output and error oscillate as one
constexpr double kOtherPeriod = 0.35;  // in ln: a candidate further off is another one
constexpr double kSlowTilt = 0.7;
constexpr double kClearlyRegular = 5, kClearShare = 0.5;
// Of fit_hysteresis: clear, and in part.
constexpr double kDeadBandGain = 0.6, kDeadBandExplained = 0.75, kDeadBandLinear = 0.8, kSureDeadBand = 1.2;
constexpr double kLeastBandRatio = 0.4, kMostBandRatio = 1.1;
constexpr double kPartGain = 0.28, kPartExplained = 0.4, kPartLinear = 0.65, kPartLeast = 0.55, kPartMost = 1;
constexpr int kPartTurns = 3;
constexpr double kPerhapsBand = 0.2;
// A linear loop with a dead time that is resolved explains the record: no dead band is needed.
constexpr double kInformed = 35, kQuickByDeadTime = 0.15, kLeastPaceSeen = 0.22, kMostPaceSeen = 0.7;
constexpr double kSlowCrossover = 0.7, kForward = 0.6, kBeyondRounding = 3;
constexpr double kResolvedRows = 1.6;                    // of the fit, in its dead time: below it the rows decide
constexpr double kCyclesInTi[] = {3, 6};                 // a limit cycle of a PI loop lasts some integral times
constexpr double kShortestCycle = 8, kFewestCycles = 6;  // rows; cycles in the record
constexpr std::size_t kCrossingBlocks = 200;

std::string percent(double share) { return figure_text(100 * share) + " %"; }

class Diagnosis {
public:
    Diagnosis(const CauseQuestion& q, const std::stop_token& stop)
        : q_(q), stop_(stop), error_(q.samples.error()), sign_(q.law.gain < 0 ? -1 : 1) {}

    Cause result() {
        if (auto found = by_service()) return *found;
        look_at_oscillation();
        if (auto found = by_limits()) return *found;
        if (auto found = by_steps_of_measurement()) return *found;
        if (auto found = by_valve()) return *found;
        if (auto found = by_dead_band()) return *found;
        if (auto found = by_oscillation()) return *found;
        if (auto found = by_set_point()) return *found;
        if (auto found = by_what_is_missing()) return *found;
        return by_speed();
    }

private:
    Cause cause(Verdict verdict, Confidence confidence, std::vector<Verdict> alternatives = {}) const {
        Cause out{.verdict = verdict, .confidence = confidence};
        out.alternatives = std::move(alternatives);
        out.period = no_figure("This cause makes no cycle.");
        out.size = out.jump = no_figure("Only a sticking valve or a backlash has one.");
        out.evidence = evidence_;
        return out;
    }
    Cause open(const std::string& why, std::vector<Verdict> alternatives) const {
        Cause out = cause(Verdict::undetermined, Confidence::open, std::move(alternatives));
        out.why_open = why;
        return out;
    }
    void add(const char* code, double value, std::optional<double> limit, const std::string& detail) {
        evidence_.push_back({code, value, limit, detail});
    }
    std::string time(double rows) const { return q_.units.time_text(rows * q_.samples.step); }

    std::optional<Cause> by_service() {
        const double frozen = q_.service.measurement_still, held = q_.service.output_still;
        // A mode that is recorded says more than an output that rests.
        const double manual = q_.service.manual.value_or(held);
        const bool y_rests = !(deviation(q_.samples.y) > 0), u_rests = !(deviation(q_.samples.u) > 0);
        if (y_rests && u_rests)
            return open(
                "Neither the measurement nor the output moves: the unit is out of service, or nothing was "
                "recorded.",
                {Verdict::frozen, Verdict::manual});
        if (y_rests || (frozen >= kFrozenShare && held < kHeldShare)) {
            add("measurement-still", frozen, kFrozenShare,
                "The measurement stands still for " + percent(frozen) + " of the time while the output moves.");
            return cause(Verdict::frozen, Confidence::sure);
        }
        if (const double longest = q_.service.longest_still; longest >= kFrozenRun && manual < kHeldShare) {
            add("measurement-still", longest, kFrozenRun,
                "The measurement stands still for " + percent(longest) +
                    " of the time in one piece while the output moves, and never nearly as long otherwise.");
            return cause(Verdict::frozen, Confidence::likely, {Verdict::stiction, Verdict::saturation});
        }
        const bool at_limit = q_.service.saturated_low + q_.service.saturated_high >= kSaturatedShare;
        if ((u_rests && !at_limit) || manual >= kHeldShare) {
            add("output-held", manual, kHeldShare,
                "For " + percent(manual) + " of the time nobody controls: the loop is in manual, or its output rests.");
            return cause(Verdict::manual, Confidence::sure);
        }
        return std::nullopt;
    }

    void look_at_oscillation() {
        const auto skip = std::size_t(kSettling * double(q_.samples.size()));
        const PeakSearch in_output{std::span(q_.samples.u).subspan(skip)}, in_error{std::span(error_).subspan(skip)};
        output_ = in_output.strongest();
        of_error_ = in_error.strongest();
        const bool by_output = output_.regularity * output_.share >= of_error_.regularity * of_error_.share;
        peak_ = by_output ? output_ : of_error_;
        const Peak& other = by_output ? of_error_ : output_;
        const bool same = of_error_.period > 0 && std::abs(output_.period / of_error_.period - 1) < kSamePeriod;
        drifts_ = std::min(output_.spread, of_error_.spread) >= kDrifts;
        line_ = same && !drifts_ ? std::min(output_.line, of_error_.line) : 0;
        candidates_ = {{peak_.period, peak_.line_period, line_}};
        if (!(peak_.regularity > kClearlyRegular && peak_.share > kClearShare)) {
            for (const Peak& more : {other, in_output.strongest(kSlowTilt), in_error.strongest(kSlowTilt)})
                add_candidate({more.period, more.line_period, 0});
        }
        if (peak_.regularity > kRegular && peak_.cycles >= kFewestCyclesTold)
            add("regularity", peak_.regularity, kRegular,
                std::string(same        ? "Output and error oscillate"
                            : by_output ? "The output oscillates"
                                        : "The error oscillates") +
                    " with a period of " + time(peak_.period) + " and a regularity of " +
                    figure_text(peak_.regularity) + "; above " + text(kRegular) + " is regular.");
    }

    std::optional<Cause> by_limits() {
        const double at_limit = q_.service.saturated_low + q_.service.saturated_high;
        if (at_limit < kSaturatedShare) return std::nullopt;
        const bool upper = q_.service.saturated_high >= q_.service.saturated_low;
        const double at_one = std::max(q_.service.saturated_low, q_.service.saturated_high);
        add("at-limit", at_limit, kSaturatedShare,
            std::string("The output is at its ") + (upper ? "upper" : "lower") + " limit, " +
                q_.units.u_text(upper ? q_.u_range.high : q_.u_range.low) + ", for " + percent(at_one) +
                " of the time" +
                (at_limit - at_one >= kSaturatedShare ? ", and at the other one for " + percent(at_limit - at_one)
                                                      : "") +
                ".");
        if (peak_.regularity >= 2.5 && peak_.cycles >= 10 && limit_visits() >= 0.25 * peak_.cycles &&
            peak_.persistence > 0.5) {
            Cause out = cause(Verdict::tight, Confidence::likely, {Verdict::saturation});
            out.period = peak_.period * q_.samples.step;
            return out;
        }
        return cause(Verdict::saturation, Confidence::sure);
    }

    double limit_visits() const {
        double visits = 0;
        bool before = false;
        for (const double u : q_.samples.u) {
            const bool now = q_.u_range.at_limit(u);
            visits += now && !before ? 1 : 0;
            before = now;
        }
        return visits;
    }

    std::optional<Cause> by_steps_of_measurement() {
        const double coarse = q_.quality.y_step / std::max(deviation(q_.samples.y), 1e-300);
        if (coarse < kCoarseStep) return std::nullopt;
        add("coarse-measurement", coarse, kCoarseStep,
            "The measurement moves in steps of " + q_.units.y_text(q_.quality.y_step) + ", " + figure_text(coarse) +
                " of its standard deviation.");
        return cause(Verdict::quantised, Confidence::sure);
    }

    void add_cycles_of_law() {
        if (peak_.regularity > kClearlyRegular && peak_.share > kClearShare) return;
        if (!(q_.law.explained > 0.5 && std::isfinite(q_.law.Ti) && q_.law.Ti > 0)) return;
        for (const double cycles : kCyclesInTi) {
            const double period = cycles * q_.law.Ti / q_.samples.step;
            if (period >= kShortestCycle && period <= double(q_.samples.size()) / kFewestCycles)
                add_candidate({period, period, 0});
        }
    }

    void add_candidate(const PeriodCandidate& more) {
        if (!(more.period > 0)) return;
        const bool known = std::ranges::any_of(candidates_, [&](const PeriodCandidate& c) {
            return c.period > 0 && std::abs(std::log(more.period / c.period)) <= kOtherPeriod;
        });
        if (!known) candidates_.push_back(more);
    }

    std::optional<Cause> by_valve() {
        add_cycles_of_law();
        bank_.emplace(q_.samples.u, peak_.period);
        measurement_ = error_;
        for (double& value : measurement_) value = -value;
        std::optional<ValveFit> best;
        for (const PeriodCandidate& candidate : candidates_) {
            if (stop_.stop_requested() || !(candidate.period > 0)) break;
            const auto fit = fit_valve(measurement_, *bank_, candidate, peak_.regularity, sign_);
            if (fit && fit->passes && (!best || fit->strength > best->strength)) best = fit;
        }
        if (!best) return std::nullopt;
        add("valve-explains", best->gain, {},
            "A valve that sticks explains the measurement better than the output itself: the unexplained square is " +
                percent(1 - std::exp(-best->gain)) + " less, in at least half of the tenths of " + judged_part() + ".");
        const bool sure = best->gain >= kSureValveGain && best->strength >= kSureValveStrength;
        return of_valve(best->band, best->jump, sure, best->period * q_.samples.step);
    }

    /// The tests of valves look at the end of a very long record.
    std::string judged_part() const {
        const bool whole = bank_->rows() + bank_->stride() > q_.samples.size();
        return whole ? "the record" : "the last " + time(double(bank_->rows())) + " of the record";
    }

    Cause of_valve(double band, double jump, bool sure, Figure period) {
        add("valve-band", band, {}, "Its dead band and stick together are about " + q_.units.u_text(band) + ".");
        Cause out = cause(Verdict::stiction, sure ? Confidence::sure : Confidence::likely, {Verdict::backlash});
        out.size = band;
        out.jump = jump;
        out.period = std::move(period);
        return out;
    }

    /// The loop's own oscillation, whose phase drifts.
    bool hardly_damped() const {
        const bool resonant =
            (peak_.regularity >= kResonant && peak_.persistence >= kPersistent && peak_.cycles >= kCyclesOfResonance) ||
            (peak_.regularity >= kLongResonant && peak_.persistence >= kLongPersistent && peak_.cycles >= kLongCycles);
        return resonant && drifts_;
    }

    std::optional<Cause> by_dead_band() {
        if (hardly_damped()) return std::nullopt;
        const auto fit = fit_hysteresis(q_.samples.y, q_.samples.r, *bank_, peak_.period);
        const bool line = line_ >= kLine && peak_.cycles >= 8;
        if (!fit || fit->plant_gain * sign_ <= 0 || line || fit->turns < 2) return std::nullopt;
        const bool in_range = fit->ratio >= kLeastBandRatio && fit->ratio <= kMostBandRatio;
        if (fit->gain >= kPerhapsBand && in_range && !linear_loop()) perhaps_band_ = fit->gain;
        const bool clear = fit->explained >= kDeadBandExplained && fit->gain >= kDeadBandGain && in_range &&
                           fit->explained_without < kDeadBandLinear;
        const bool in_part = fit->gain >= kPartGain && fit->explained_without < kPartLinear &&
                             fit->ratio >= kPartLeast && fit->ratio <= kPartMost && fit->turns >= kPartTurns &&
                             fit->explained >= kPartExplained;
        if ((!clear && !in_part) || linear_loop()) return std::nullopt;
        add("dead-band", fit->explained, {},
            "The measurement follows the output only through a dead band: with it the output explains " +
                percent(fit->explained) + " of the measurement, without it " + percent(fit->explained_without) + ".");
        return of_valve(fit->band, fit->jump, clear && fit->gain >= kSureDeadBand,
                        no_figure("The valve moves too seldom for a period."));
    }

    std::optional<Cause> by_oscillation() {
        if (line_ >= kLine && peak_.persistence >= 0.6 && (peak_.cycles >= 8 || (peak_.cycles >= 6 && line_ >= 0.97))) {
            add("one-frequency", line_, kLine,
                percent(line_) +
                    " of the oscillation is one exact frequency over the whole record: that of a "
                    "sticking valve or a tight loop would drift.");
            Cause out = cause(Verdict::external,
                              line_ >= kSureLine && peak_.cycles >= 8 ? Confidence::sure : Confidence::likely,
                              {Verdict::tight, Verdict::stiction});
            out.period = peak_.line_period * q_.samples.step;
            return out;
        }
        if (hardly_damped()) {
            add("resonance", peak_.persistence, kPersistent,
                "After three periods the oscillation still has a correlation of " + figure_text(peak_.persistence) +
                    " with itself, its phase drifts, and no valve explains it: the loop itself hardly damps it.");
            const bool sure = peak_.regularity >= kSurelyResonant && peak_.persistence >= kSurelyPersistent &&
                              peak_.cycles >= kSureCycles;
            Cause out = cause(Verdict::tight, sure ? Confidence::sure : Confidence::likely, {Verdict::external});
            out.period = peak_.period * q_.samples.step;
            return out;
        }
        if ((peak_.regularity >= kOscillates && peak_.share > kClearShare) ||
            (line_ >= 0.85 && peak_.persistence >= 0.6)) {
            Cause out =
                open("The loop oscillates, over " + figure_text(std::floor(peak_.cycles)) +
                         " cycles, but the record does not show whether the valve, a disturbance or the tuning is "
                         "the cause. Record for longer, or put the loop in manual for some periods.",
                     {Verdict::stiction, Verdict::tight, Verdict::external});
            out.period = peak_.period * q_.samples.step;
            return out;
        }
        return std::nullopt;
    }

    /// How often block means of the error beyond the noise change their sign; many where the set point is unknown.
    int crossings() const {
        const std::size_t count = std::max<std::size_t>(1, error_.size() / kCrossingBlocks);
        const double least = 2 * noise_std(error_) / std::sqrt(double(count));
        int changes = 0;
        std::size_t beyond = 0, blocks = 0;
        double before = 0;
        for (const double value : block_means(error_, count)) {
            ++blocks;
            if (std::abs(value) <= least) continue;
            ++beyond;
            if (value * before < 0) ++changes;
            before = value;
        }
        const bool known = !q_.samples.r.empty() && 2 * beyond >= blocks;
        return known ? changes : kFewestCrossings;
    }

    /// The share of rows that are not just behind a move of the set point.
    double free_of_moves() const {
        const auto& r = q_.samples.r;
        if (r.empty() || !std::isfinite(q_.law.Ti) || !(q_.law.Ti > 0)) return 1;
        const auto reach = std::size_t(std::min(kMoveReach * q_.law.Ti / q_.samples.step, double(r.size())));
        std::size_t free = 0, since = reach + 1;
        for (std::size_t i = 0; i < r.size(); ++i) {
            since = i > 0 && r[i] != r[i - 1] ? 0 : since + 1;
            free += since > reach ? 1 : 0;
        }
        return double(free) / double(r.size());
    }

    /// Such a level is slow on purpose.
    bool smooths_flows() const { return q_.loop.averaging.value_or(false); }

    /// Moves of the set point show by themselves how quick the loop is.
    std::optional<Cause> by_set_point() {
        const auto response = set_point_response(q_.samples);
        if (!response || response->noise > kClearResponse) return std::nullopt;
        // A dead time that the rows do not resolve is at most two of them.
        const bool resolved = response->dead_time >= 2 * q_.samples.step;
        const double ratio = response->rise / std::max(response->dead_time, 2 * q_.samples.step);
        if (!resolved && ratio < kSluggishRise) return std::nullopt;
        add("set-point-response", ratio, kSluggishRise,
            "After " + counted(response->moves, "move") + " of the set point the measurement needs " +
                q_.units.time_text(response->rise) + " to 63 %, " + (resolved ? "" : "at least ") + figure_text(ratio) +
                " times the time until it begins; a loop tuned for its dead time needs 1 to 2 times.");
        quick_after_moves_ = ratio < kSluggishRise || smooths_flows();
        if (quick_after_moves_) return std::nullopt;
        return cause(Verdict::sluggish,
                     response->moves > 1 && ratio > 1.5 * kSluggishRise ? Confidence::sure : Confidence::likely);
    }

    std::optional<Cause> by_what_is_missing() {
        if (crossings() < 2) return few_crossings();
        if (perhaps_band_ > 0)
            return open(
                "A dead band of the valve would explain the measurement better, but the valve turns too seldom to "
                "prove it. A longer record tells.",
                {Verdict::stiction, Verdict::healthy, Verdict::sluggish});
        if (quick_after_moves_) return cause(Verdict::healthy, Confidence::likely);
        const double free = free_of_moves();
        const bool moves = !q_.samples.r.empty() && deviation(q_.samples.r) > 1.5 * deviation(error_);
        if (free < kFreeOfMoves && moves)
            return open("Only " + percent(free) +
                            " of the record is free of set-point moves: how the loop treats loads "
                            "does not show. Identify the plant from these moves instead.",
                        {Verdict::healthy, Verdict::sluggish, Verdict::stiction});
        return std::nullopt;
    }

    Cause few_crossings() const {
        return open("The error changes its sign only " + std::to_string(crossings()) +
                        " times: the record is short against this loop. Record for several times as long.",
                    {Verdict::sluggish, Verdict::stiction});
    }

    const std::optional<LoopSpeed>& speed() {
        if (asked_speed_) return speed_;
        asked_speed_ = true;
        if (!(q_.law.explained >= kKnownLaw && std::isfinite(q_.law.Ti) && q_.law.Ti > 0)) return speed_;
        std::vector<double> y(q_.samples.y);
        for (double& value : y) value *= sign_;
        speed_ = loop_speed(y, q_.samples.u, std::abs(q_.law.gain), q_.law.Ti, q_.samples.step, stop_);
        return speed_;
    }

    bool linear_loop() {
        const auto& found = speed();
        return found && found->information >= kInformed && found->by_dead_time < kQuickByDeadTime &&
               found->pace >= kLeastPaceSeen && found->pace <= kMostPaceSeen;
    }

    /// Rounding of the output moves the fit where only the dead time speaks.
    bool tells_slow(const LoopSpeed& found) const {
        const bool by_crossover = found.crossover_Ti < kSlowCrossover;
        const bool by_dead_time =
            found.by_dead_time >= kSurelySlow && noise_std(q_.samples.u) >= kBeyondRounding * q_.quality.u_step;
        return (by_crossover || by_dead_time) && found.load_steps > 0 && found.forward >= kForward &&
               found.dead_time > kResolvedRows * found.resolution;
    }

    Cause by_speed() {
        const auto& found = speed();
        if (found && found->pace > 0 && (found->information >= kInformed || found->slow >= kSlow)) {
            add("pace", found->pace, {},
                "Crossover frequency times dead time is about " + figure_text(found->pace) +
                    ": 0.5 is quick, below 0.19 the loop is slower than its dead time allows.");
            if (found->slow >= kSlow && tells_slow(*found) && !smooths_flows()) {
                add("slow", found->slow, kSlow,
                    "By the reaction to " + counted(found->load_steps, "step") +
                        " of the load the loop is sluggish with a likelihood of " + percent(found->slow) + ".");
                return cause(Verdict::sluggish, Confidence::likely, {Verdict::healthy});
            }
        }
        if (crossings() < kFewestCrossings) return few_crossings();
        add("no-fault", 0, {},
            std::string(peak_.regularity > kRegular ? "The oscillation is too weak or too irregular to have a cause; no"
                                                    : "No oscillation, no") +
                " limit and no fault of the valve is seen.");
        const bool doubtful = !smooths_flows() && (!found || found->slow >= kPerhapsSlow);
        return cause(Verdict::healthy, Confidence::likely,
                     doubtful ? std::vector{Verdict::sluggish} : std::vector<Verdict>{});
    }

    const CauseQuestion& q_;
    const std::stop_token& stop_;
    std::vector<double> error_, measurement_;
    double sign_;  // of the plant's gain
    Peak output_, of_error_, peak_;
    bool drifts_ = false;
    double line_ = 0;
    std::vector<PeriodCandidate> candidates_;
    std::optional<ValveBank> bank_;
    bool asked_speed_ = false;
    std::optional<LoopSpeed> speed_;
    bool quick_after_moves_ = false;  // of the set point
    double perhaps_band_ = 0;         // gain of a dead band that is not proven
    std::vector<Evidence> evidence_;
};

}  // namespace

Cause cause_of(const CauseQuestion& question, const std::stop_token& stop) {
    return Diagnosis(question, stop).result();
}

Cause insufficient(const RecordQuality& quality) {
    Cause cause{.verdict = Verdict::insufficient_data};
    cause.size = cause.jump = cause.period = no_figure("The record is not good enough.");
    for (const Warning& remark : quality.remarks)
        if (remark.level == WarningLevel::bad && cause.why_open.empty()) cause.why_open = remark.detail;
    return cause;
}

}  // namespace tunewright::check
