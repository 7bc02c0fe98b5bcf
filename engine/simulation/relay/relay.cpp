#include "engine/simulation/relay/relay.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/number_text.h"
#include "engine/simulation/relay/relay_cycle.h"
#include "engine/simulation/relay/relay_sampled.h"

namespace tunewright {
namespace {

constexpr double kRowsPerPeriod = 200;
constexpr double kRowTolerance = 1e-9;         // of the rows' spacing: closer times are one row
constexpr double kWholeRatioTolerance = 1e-6;  // relative: a ratio of decimal times that is whole except for rounding
constexpr int kMaxEnlargements = 20;           // of the levels, until the swing of y is large enough
constexpr double kMinRaise = 1.1;          // factor of the levels each time, because at the end the swing is too small
                                           // only by rounding
constexpr double kBlindRaise = 2;          // factor if the relay does not oscillate with these levels
constexpr double kHysteresisPerNoise = 3;  // ratio of hysteresis to noise_std
constexpr double kSwingPerHysteresis = 3;  // ratio of y's amplitude to the hysteresis
constexpr int kQuietCycles = 3, kNoisyCycles = 10;

Error refuse(const char* field, const std::string& message) {
    return {ErrorKind::invalid_argument, std::string("relay/") + field, message};
}

Error stopped() { return {ErrorKind::cancelled, {}, "The simulation was stopped."}; }

double wrapped(double angle) {
    const double turn = 2 * std::numbers::pi;
    angle = std::fmod(angle, turn);
    return angle > 0 ? angle - turn : angle;
}

LimitCycle describe(const LinearPlant& plant, const RelaySettings& settings, const SteadyRelayCycle& steady) {
    LimitCycle out;
    out.Pu = steady.Pu();
    const std::complex<double> j(0, 1);
    const double omega = 2 * std::numbers::pi / out.Pu;
    const std::complex<double> G = plant.at(j * omega);
    out.Au = std::abs(G);
    out.phi_u = wrapped(std::arg(G));
    out.periods = std::max(0, settings.cycles - steady.settling_cycles);
    const double sigma = settings.shift.value_or(1 / out.Pu);
    const std::complex<double> shifted = plant.at(sigma + j * omega);
    out.shift = ShiftedPoint{sigma, std::abs(shifted), wrapped(std::arg(shifted))};
    const double d = (settings.u_plus - settings.u_minus) / 2, a = (steady.y_max - steady.y_min) / 2;
    out.describing_function = UltimatePoint{steady.direction * 4 * d / (std::numbers::pi * a), out.Pu};
    out.t_plus = steady.t_plus;
    out.t_minus = steady.t_minus;
    out.y_max = steady.y_max;
    out.y_min = steady.y_min;
    return out;
}

// The default spacing of rows: as fine as is useful, or wider if the record would be too long.
double interval(const RelaySettings& settings, const SteadyRelayCycle& steady) {
    if (settings.record_interval) return *settings.record_interval;
    const double max = 0.9 * static_cast<double>(kMaxRelayRows) - 2.0 * settings.cycles;
    const double fitting = settings.cycles * steady.Pu() / max, Ts = settings.relay_sample_time;
    return Ts > 0 ? Ts * std::max(1.0, std::ceil(fitting / Ts)) : std::max(steady.Pu() / kRowsPerPeriod, fitting);
}

std::optional<Error> refuse_rows(const RelaySettings& settings, const SteadyRelayCycle& steady, double spacing) {
    const double rows = settings.cycles * (steady.Pu() / spacing + 2);
    if (rows <= static_cast<double>(kMaxRelayRows)) return std::nullopt;
    const double fitting = settings.cycles * steady.Pu() / (static_cast<double>(kMaxRelayRows) - 2.0 * settings.cycles);
    return refuse("record_interval", "record_interval is " + text(spacing) + "; " + std::to_string(settings.cycles) +
                                         " cycles of about " + text(steady.Pu()) + " would make " + text(rows) +
                                         " rows, but at most 100000 are recorded. Use fewer cycles, or rows at least " +
                                         text(1.01 * fitting) + " apart.");
}

Error full_record(const RelaySettings& settings, int cycles) {
    return refuse("cycles", "cycles is " + std::to_string(settings.cycles) + "; the record was full after " +
                                std::to_string(cycles) + ". Use fewer cycles or a longer record_interval.");
}

void add_row(RelayRecord& record, double t, double u, double y) {
    record.t.push_back(t);
    record.u.push_back(u);
    record.y.push_back(y);
}

std::optional<Error> record_events(const LinearPlant& plant, const RelaySettings& settings,
                                   const SteadyRelayCycle& steady, double spacing, const RunControl& control,
                                   RelayRecord& record) {
    RelayMotion motion(plant, steady.direction);
    const RelayLevels levels{settings.u_plus, settings.u_minus, settings.hysteresis};
    RelayRun run(motion, plant.dead_time(), levels, held_start(plant, levels));
    int switches = 0;
    std::int64_t row = 0;
    while (const auto piece = run.next()) {
        if ((run.steps() & 1023) == 0 && control.stop.stop_requested()) return stopped();
        // A row closer to a switch than the rounding of t is the switch's own row.
        const double last = piece->switched ? piece->t_end - kRowTolerance * spacing : piece->t_end;
        for (double t = static_cast<double>(row) * spacing; t < last; t = static_cast<double>(++row) * spacing) {
            if (!record.t.empty() && t <= record.t.back() + kRowTolerance * spacing) continue;
            if (record.t.size() >= kMaxRelayRows) return full_record(settings, switches / 2);
            add_row(record, t, piece->u, steady.direction * piece->y.at(std::max(0.0, t - piece->t)));
        }
        if (!piece->switched) continue;
        if (!record.t.empty() && record.t.back() == piece->t_end)
            record.u.back() = run.u();
        else
            add_row(record, piece->t_end, run.u(), steady.direction * run.y());
        if (++switches == 2 * settings.cycles) return std::nullopt;
    }
    return Error{ErrorKind::unsupported, "plant",
                 "The run from rest ended after " + std::to_string(switches / 2) +
                     " cycles, because it reached the allowed number of steps. Use fewer cycles."};
}

std::optional<Error> record_samples(const LinearPlant& plant, const RelaySettings& settings,
                                    const SteadyRelayCycle& steady, double spacing, const RunControl& control,
                                    RelayRecord& record) {
    const RelayMotion motion(plant, steady.direction);
    SampledRelay relay(motion, plant.dead_time(), {settings.u_plus, settings.u_minus, settings.hysteresis},
                       settings.relay_sample_time, settings.noise_std, static_cast<std::uint64_t>(settings.seed));
    const auto every = static_cast<std::int64_t>(std::llround(spacing / settings.relay_sample_time));
    constexpr std::int64_t kMaxSamples = 10'000'000;
    int switches = 0;
    for (std::int64_t k = 0; k < kMaxSamples; ++k) {
        if ((k & 4095) == 0 && control.stop.stop_requested()) return stopped();
        const SampledRelay::Sample sample = relay.next();
        if (sample.switched || k % every == 0) {
            if (record.t.size() >= kMaxRelayRows) break;
            add_row(record, sample.t, sample.u, steady.direction * sample.y);
        }
        if (sample.switched && ++switches == 2 * settings.cycles) return std::nullopt;
    }
    return full_record(settings, switches / 2);
}

void add_warnings(const LinearPlant& plant, const RelaySettings& settings, const SteadyRelayCycle& steady,
                  RelayExperiment& out) {
    if (out.reversed)
        out.warnings.push_back({"relay-reversed",
                                "A positive u gives a negative y, so the relay acts on -y (to u_minus when y < "
                                "-hysteresis); otherwise it would latch."});
    if (const double held = held_start(plant, {settings.u_plus, settings.u_minus, settings.hysteresis});
        held > 0 && settings.relay_sample_time == 0)
        out.warnings.push_back({"start-held",
                                "Without dead time and hysteresis a relay at rest cannot start: the record begins with "
                                "u_plus, held for " +
                                    text(held) + "."});
    if (out.limit_cycle.periods == 0)
        out.warnings.push_back({"not-settled", "The oscillation takes " + std::to_string(steady.settling_cycles) +
                                                   " cycles to become steady, but the record has " +
                                                   std::to_string(settings.cycles) + ". Ask for " +
                                                   std::to_string(out.plan.cycles) + " cycles."});
    if (plant.integrators() > 0 && settings.u_plus != -settings.u_minus)
        out.warnings.push_back({"integrating-plant",
                                "On an integrating plant the mean of u over a steady period is 0 for any bias, so the "
                                "ratio of the means of y and u does not depend on the plant."});
    const double mean = out.record.t.back() / settings.cycles;
    if (settings.noise_std > 0 && mean < steady.Pu() / 2)
        out.warnings.push_back({"noise-switches-relay", "Noise switches the relay: its cycles take " + text(mean) +
                                                            " on average instead of " + text(steady.Pu()) +
                                                            ". Raise the hysteresis to " + text(out.plan.hysteresis) +
                                                            ", 3 noise_std."});
}

// ---- the plan ----

double amplitude(const SteadyRelayCycle& cycle) { return (cycle.y_max - cycle.y_min) / 2; }

// Scaling levels and hysteresis together scales y: the cycle for levels f u and hysteresis eps is f times that for u
// and eps/f.
std::optional<SteadyRelayCycle> enlarged(const LinearPlant& plant, const RelayLevels& levels, double& factor,
                                         const RunControl& control) {
    std::optional<SteadyRelayCycle> best;
    for (int i = 0; i < kMaxEnlargements; ++i) {
        const RelayLevels scaled{levels.u_plus, levels.u_minus, levels.hysteresis / factor};
        auto cycle = steady_relay_cycle(plant, scaled, control);
        if (cycle) {
            const double short_of = kSwingPerHysteresis * scaled.hysteresis / amplitude(*cycle);
            best = *cycle;
            if (short_of <= 1) break;
            factor *= std::max(short_of, kMinRaise);
        } else if (cycle.error().kind == ErrorKind::cancelled) {
            return std::nullopt;
        } else {
            factor *= kBlindRaise;
        }
    }
    return best;
}

std::string sentence(const RelayPlan& plan, const RelaySettings& settings, int settling, double factor) {
    std::string out;
    if (settings.noise_std > 0) {
        out = "hysteresis is 3 noise_std: on average one noisy sample in 741 crosses it by chance. ";
        out += factor > 1 ? "The levels are " + text(factor) + " times the given ones, so that y swings "
                          : std::string("With the levels given y swings ");
        out += text(plan.amplitude / plan.hysteresis) + " times the hysteresis to either side. ";
    } else {
        out = "Levels and hysteresis as given; enter the noise to get a hysteresis. ";
    }
    out += std::to_string(settling) + (settling == 1 ? " cycle" : " cycles") + " to settle and " +
           std::to_string(plan.cycles - settling) +
           (settings.noise_std > 0 ? " to average: the error falls with the square root of their "
                                     "number."
                                   : " to measure.");
    return out;
}

/// The largest of 1, 2, 5 times a power of ten that is at most x > 0.
double round_down(double x) {
    const double power = std::pow(10.0, std::floor(std::log10(x)));
    const double first = x / power;
    return power * (first >= 5 ? 5 : first >= 2 ? 2 : 1);
}

/// `steady`: the cycle with the given settings.
RelayPlan plan_relay(const LinearPlant& plant, const RelaySettings& settings, const SteadyRelayCycle& steady,
                     const RunControl& control) {
    const bool noisy = settings.noise_std > 0;
    RelayLevels levels{settings.u_plus, settings.u_minus,
                       noisy ? kHysteresisPerNoise * settings.noise_std : settings.hysteresis};
    SteadyRelayCycle cycle = steady;
    double factor = 1;
    if (noisy) {
        if (const auto better = enlarged(plant, levels, factor, control)) {
            cycle = *better;
        } else {
            factor = 1;
            levels.hysteresis = settings.hysteresis;
        }
    }
    RelayPlan plan;
    plan.u_plus = factor * levels.u_plus;
    plan.u_minus = factor * levels.u_minus;
    plan.hysteresis = levels.hysteresis;
    plan.amplitude = factor * amplitude(cycle);
    plan.expected_period = cycle.Pu();
    plan.cycles = std::min(cycle.settling_cycles + (noisy ? kNoisyCycles : kQuietCycles), kMaxRelayCycles);
    plan.duration = plant.dead_time() + plan.cycles * cycle.Pu();
    const double spacing = cycle.Pu() / kRowsPerPeriod, Ts = settings.relay_sample_time;
    plan.record_interval = Ts > 0 ? Ts * std::max(1.0, std::floor(spacing / Ts)) : round_down(spacing);
    plan.reason = sentence(plan, settings, plan.cycles - (noisy ? kNoisyCycles : kQuietCycles), factor);
    return plan;
}

}  // namespace

std::optional<Error> refuse_settings(const RelaySettings& settings) {
    const auto& s = settings;
    if (!(s.u_minus < s.u_plus))
        return refuse("u_minus", "u_minus is " + text(s.u_minus) + "; it must be less than u_plus, " + text(s.u_plus) +
                                     ". Swap the two values.");
    if (!(s.hysteresis >= 0)) return refuse("hysteresis", "hysteresis must be >= 0.");
    if (!(s.noise_std >= 0)) return refuse("noise_std", "noise_std must be >= 0.");
    if (!(s.relay_sample_time >= 0)) return refuse("relay_sample_time", "relay_sample_time must be >= 0.");
    if (s.noise_std > 0 && s.relay_sample_time == 0)
        return refuse("relay_sample_time",
                      "relay_sample_time is 0 and noise_std > 0; noise belongs to samples. Give the relay's sample "
                      "time, or set noise_std to 0.");
    if (s.cycles < 1 || s.cycles > kMaxRelayCycles)
        return refuse("cycles", "cycles is " + std::to_string(s.cycles) + "; it must be 1 to 1000.");
    if (s.seed < 0) return refuse("seed", "seed must be >= 0.");
    if (s.shift && !(*s.shift > 0)) return refuse("shift", "shift must be > 0.");
    if (!s.record_interval) return std::nullopt;
    if (!(*s.record_interval > 0)) return refuse("record_interval", "record_interval must be > 0.");
    const double ratio = s.relay_sample_time > 0 ? *s.record_interval / s.relay_sample_time : 1;
    if (ratio < 0.5 || std::abs(ratio - std::round(ratio)) > kWholeRatioTolerance * ratio)
        return refuse("record_interval", "record_interval is " + text(*s.record_interval) +
                                             "; it must be a whole multiple of relay_sample_time, " +
                                             text(s.relay_sample_time) + ". Omit it to record every sample.");
    return std::nullopt;
}

Expected<RelayExperiment> simulate_relay(const Plant& given, const RelaySettings& settings, const RunControl& control) {
    if (auto error = refuse_settings(settings)) return *error;
    const auto plant = LinearPlant::make(given);
    if (!plant) return plant.error();
    const RelayLevels levels{settings.u_plus, settings.u_minus, settings.hysteresis};
    const bool sampled = settings.relay_sample_time > 0;
    if (sampled && plant->dead_time() > kMaxDeadSamples * settings.relay_sample_time)
        return refuse("relay_sample_time", "relay_sample_time is " + text(settings.relay_sample_time) +
                                               "; the dead time can have at most 1000000 samples. Use a longer "
                                               "relay_sample_time.");
    const auto steady = sampled ? steady_sampled_cycle(*plant, levels, settings.relay_sample_time, control)
                                : steady_relay_cycle(*plant, levels, control);
    if (!steady) return steady.error();

    RelayExperiment out;
    out.reversed = steady->direction < 0;
    out.limit_cycle = describe(*plant, settings, *steady);
    const double spacing = interval(settings, *steady);
    if (auto error = refuse_rows(settings, *steady, spacing)) return *error;
    const auto failed = sampled ? record_samples(*plant, settings, *steady, spacing, control, out.record)
                                : record_events(*plant, settings, *steady, spacing, control, out.record);
    if (failed) return *failed;
    out.plan = plan_relay(*plant, settings, *steady, control);
    if (control.stop.stop_requested()) return stopped();
    add_warnings(*plant, settings, *steady, out);
    return out;
}

}  // namespace tunewright
