#include "tests/engine/identification/simulated_controller.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "tests/records/random.h"

namespace tunewright::records {
namespace {

double rounded(double value, double step) { return step > 0 ? step * std::round(value / step) : value; }

/// The program: one call a sample. Ideal and series are positional with a clamped integral, velocity adds increments.
class Program {
public:
    explicit Program(const SimulatedController& loop) : l_(loop) {}

    double step(double r, double y, bool automatic, double manual_u) {
        if (!started_) {
            automatic = false;  // switched on without a bump
            yf_ = yf1_ = yf2_ = y;
            r1_ = r2_ = r;
            e1_ = r - y;
            u_ = manual_u;
            started_ = true;
        }
        const double weight = l_.filter == ProgramFilter::measurement ? l_.Ts / (l_.Tf + l_.Ts) : 1;
        yf_ += weight * (y - yf_);
        const double e = r - yf_;
        double boost = 1 + l_.gain_by_error * std::abs(e);
        const bool has_i = l_.structure != ProgramStructure::p, has_d = l_.structure == ProgramStructure::pid;
        double u = manual_u;
        if (l_.form == ProgramForm::series) {
            // Lead on the measurement, (1 + Td s)/(1 + Tf s), then PI.
            const double Tf = l_.filter == ProgramFilter::derivative ? l_.Tf : 0;
            if (!lead_started_) lead_ = yf_, lead_started_ = true;
            const double lead = has_d ? (Tf * lead_ + l_.Ts * yf_ + l_.Td * (yf_ - yf1_)) / (Tf + l_.Ts) : yf_;
            lead_ = lead;
            const double es = r - lead;
            if (automatic) {
                const double p = l_.Kp * boost * (l_.b * r - lead);
                if (has_i) integral_ += l_.Kp * l_.Ts / l_.Ti * (l_.forward ? e1_ : es);
                u = std::clamp(p + integral_, l_.u_low, l_.u_high);
                if (p + integral_ != u && has_i) integral_ = u - p;
            } else {
                integral_ = manual_u - l_.Kp * boost * (l_.b * r - lead);
            }
            e1_ = es;
        } else if (l_.form == ProgramForm::ideal) {
            const double f = l_.c * r - yf_, f1 = l_.c * r1_ - yf1_;
            const double Tf = l_.filter == ProgramFilter::derivative ? l_.Tf : 0;
            if (has_d) d_ = (Tf * d_ + l_.Kp * l_.Td * (f - f1)) / (Tf + l_.Ts);
            const double p = l_.Kp * boost * (l_.b * r - yf_) + d_;
            if (automatic) {
                if (has_i) integral_ += l_.Kp * l_.Ts / l_.Ti * (l_.forward ? e1_ : e);
                u = std::clamp(p + integral_, l_.u_low, l_.u_high);
                if (p + integral_ != u && has_i) integral_ = u - p;
            } else {
                integral_ = manual_u - p;
            }
            e1_ = e;
        } else {
            const double f = l_.c * r - yf_, f1 = l_.c * r1_ - yf1_, f2 = l_.c * r2_ - yf2_;
            double du = l_.Kp * boost * ((l_.b * (r - r1_) - (yf_ - yf1_)));
            if (has_i) du += l_.Kp * l_.Ts / l_.Ti * (l_.forward ? e1_ : e);
            if (has_d) {
                const double Tf = l_.filter == ProgramFilter::derivative ? l_.Tf : 0;
                dd_ = (Tf * dd_ + l_.Kp * l_.Td * (f - 2 * f1 + f2)) / (Tf + l_.Ts);
                du += dd_;
            }
            u = automatic ? std::clamp(u_ + du, l_.u_low, l_.u_high) : manual_u;
            e1_ = e;
        }
        yf2_ = yf1_, yf1_ = yf_, r2_ = r1_, r1_ = r;
        return u_ = u;
    }

private:
    const SimulatedController& l_;
    bool started_ = false, lead_started_ = false;
    double yf_ = 0, yf1_ = 0, yf2_ = 0, r1_ = 0, r2_ = 0, e1_ = 0, integral_ = 0, d_ = 0, dd_ = 0, lead_ = 0, u_ = 0;
};

/// The set point over time: steps or ramps between levels about `centre`.
double set_point(const SimulatedController& l, const std::vector<double>& at, const std::vector<double>& level,
                 double t, double centre) {
    double value = centre;
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (t < at[i]) break;
        const double before = value;
        value = level[i];
        if (l.set_point_ramps) {
            const double share = std::min(1.0, (t - at[i]) / (0.05 * l.duration));
            value = before + share * (level[i] - before);
        }
    }
    return value;
}

}  // namespace

double SimulatedController::ideal_Kp() const {
    if (form != ProgramForm::series || structure != ProgramStructure::pid) return Kp;
    return Kp * (Ti + Td - (filter == ProgramFilter::derivative ? Tf : 0)) / Ti;
}
double SimulatedController::ideal_Ti() const {
    if (structure == ProgramStructure::p) return std::numeric_limits<double>::infinity();
    return Ti * ideal_Kp() / Kp;
}
double SimulatedController::ideal_Td() const {
    if (structure != ProgramStructure::pid) return 0;
    if (form != ProgramForm::series) return Td;
    // Kc (1 + 1/(Ti s)) (1 + Td s)/(1 + Tf s) = P + I/s + D s/(1 + Tf s): D = Kc (Td - Tf)(1 - Tf/Ti).
    const double f = filter == ProgramFilter::derivative ? Tf : 0;
    return Kp * (Td - f) * (1 - f / Ti) / ideal_Kp();
}

SimulatedController random_controller(int seed) {
    Random random(static_cast<std::uint64_t>(seed));
    SimulatedController l;
    l.integrating = random.chance(0.2);
    l.T1 = random.spread(2, 200);
    l.T2 = random.chance(0.5) ? l.T1 * random.uniform(0.05, 0.5) : 0;
    l.L = l.T1 * random.spread(0.02, 0.6);
    l.K = random.spread(0.05, 5) * (random.chance(0.2) ? -1 : 1);
    if (l.integrating) l.K /= l.T1;
    l.structure = std::array{ProgramStructure::p, ProgramStructure::pi, ProgramStructure::pi, ProgramStructure::pid,
                             ProgramStructure::pid}[static_cast<std::size_t>(random.below(5))];
    l.form = static_cast<ProgramForm>(random.below(3));
    if (l.structure == ProgramStructure::p && l.form == ProgramForm::velocity) l.form = ProgramForm::ideal;
    l.Ts = l.T1 * random.spread(0.01, 0.2);
    const double delay = l.L + l.T2 + 0.5 * l.Ts, lambda = delay * random.spread(0.8, 4);
    l.Kp = l.integrating ? 1 / (l.K * (lambda + delay)) : l.T1 / (l.K * (lambda + delay));
    l.Ti = l.integrating ? random.uniform(2, 4) * (lambda + delay)
                         : std::min(l.T1, 4 * (lambda + delay)) * random.spread(0.7, 2);
    if (l.structure == ProgramStructure::pid) {
        l.Td = l.Ti * random.spread(0.06, 0.22);
        l.filter = static_cast<ProgramFilter>(random.below(3));
        if (l.filter == ProgramFilter::derivative) l.Tf = l.Td / random.spread(3, 20);
        if (l.filter == ProgramFilter::measurement) l.Tf = l.Td / random.spread(2, 10);
        l.c = random.chance(0.3) && l.form != ProgramForm::series ? 1 : 0;
    } else if (random.chance(0.25)) {
        l.filter = ProgramFilter::measurement;
        l.Tf = l.Ts * random.spread(0.5, 5);
        if (l.Tf > 0.2 * lambda) l.Tf = 0.2 * lambda;
    }
    if (l.form != ProgramForm::series && l.structure != ProgramStructure::p && random.chance(0.35))
        l.b = random.chance(0.5) ? 0 : random.uniform(0.2, 0.9);
    l.duration = l.T1 * random.spread(15, 60);
    l.step_size = 10;
    l.set_point_steps = random.below(6);
    l.set_point_ramps = random.chance(0.2);
    const double u_span = std::abs(l.step_size / (l.integrating ? l.K * l.T1 : l.K));
    if (random.chance(0.6)) l.load_step = u_span * random.uniform(-0.6, 0.6);
    if (random.chance(0.4)) l.load_walk = u_span * 0.3 / std::sqrt(l.T1) * random.spread(0.05, 1);
    if (random.chance(0.75)) l.noise = l.step_size * random.spread(0.0005, 0.03);
    if (random.chance(0.2)) l.manual_phases = 1 + random.below(2);
    l.with_mode = l.manual_phases > 0 && random.chance(0.4);
    if (random.chance(0.2)) l.u_low = -u_span * random.uniform(0.3, 1.2), l.u_high = u_span * random.uniform(0.6, 1.5);
    const int rows = random.below(5);
    l.row_time = l.Ts;
    if (rows == 3) l.row_time = l.Ts / (random.chance(0.7) ? 2 + random.below(6) : random.uniform(1.5, 6));
    if (rows == 4) l.row_time = l.Ts * (random.chance(0.7) ? 2 + random.below(3) : random.uniform(1.3, 4));
    if (l.row_time > 0.25 * l.T1) l.row_time = l.Ts;
    l.raw_sensor = l.row_time != l.Ts && random.chance(0.2);
    if (random.chance(0.4)) l.y_resolution = l.step_size * random.spread(0.0005, 0.02);
    if (random.chance(0.3)) l.y_record_rounding = l.step_size * random.spread(0.0005, 0.02);
    if (random.chance(0.6)) l.u_record_rounding = u_span * random.spread(0.0002, 0.02);
    l.late_by_one_row = random.chance(0.15);
    l.with_set_point = random.chance(0.85);
    return l;
}

Record recorded(const SimulatedController& l, int seed) {
    Random random(static_cast<std::uint64_t>(seed) + 7777777);
    Record out;
    const double centre = 50, u_rest = 40;
    std::vector<double> at, level;
    for (int i = 0; i < l.set_point_steps; ++i) {
        at.push_back(l.duration * (i + random.uniform(0.2, 0.8)) / l.set_point_steps);
        level.push_back(centre + l.step_size * random.uniform(-1, 1));
    }
    const double load_at = l.duration * random.uniform(0.2, 0.8);
    std::vector<std::array<double, 2>> manual;
    for (int i = 0; i < l.manual_phases; ++i) {
        const double from = l.duration * (i + random.uniform(0.1, 0.6)) / l.manual_phases;
        manual.push_back({from, from + l.duration * random.uniform(0.05, 0.3) / l.manual_phases});
    }
    const auto in_manual = [&](double t) {
        return std::ranges::any_of(manual, [&](const auto& m) { return t >= m[0] && t < m[1]; });
    };
    // The plant by small steps: exact for a lag, the dead time as a queue.
    const int per_sample = std::clamp(static_cast<int>(std::ceil(l.Ts / (0.004 * l.T1))), 6, 60);
    const double dt = l.Ts / per_sample;
    const double u_span = std::abs(l.step_size / (l.integrating ? l.K * l.T1 : l.K));
    std::deque<double> queue(static_cast<std::size_t>(std::lround(l.L / dt)) + 1, 0.0);
    double x1 = 0, x2 = 0, load = 0, walk = 0, u = 0, y_read = centre, r = centre, manual_u = 0, further = 0;
    bool automatic = true, was = true;
    Program program(l);
    double next_row = 0.37 * (l.row_time < l.Ts || l.row_time > l.Ts ? l.row_time : 0);
    double u_before = 0;
    const auto a1 = l.integrating ? 1.0 : std::exp(-dt / l.T1);
    const auto a2 = l.T2 > 0 ? std::exp(-dt / l.T2) : 0.0;
    for (long k = 0; static_cast<double>(k) * dt <= l.duration; ++k) {
        const double t = static_cast<double>(k) * dt;
        const auto keep_row = [&] {
            out.t.push_back(next_row);
            out.u.push_back(rounded(u_rest + (l.late_by_one_row ? u_before : u), l.u_record_rounding));
            u_before = u;
            const double shown =
                l.raw_sensor ? rounded(centre + x2 + l.noise * random.normal(), l.y_resolution) : y_read;
            out.y.push_back(rounded(shown, l.y_record_rounding));
            if (l.with_set_point) out.r.push_back(r);
            if (l.with_mode) out.automatic.push_back(automatic);
            next_row += l.row_time;
        };
        // A row between two steps shows what was there at its time.
        if (l.row_time != l.Ts && k > 0 && next_row < t - 1e-9 * dt) keep_row();
        if (k % per_sample == 0) {
            r = set_point(l, at, level, t, centre);
            y_read = rounded(centre + x2 + l.noise * random.normal(), l.y_resolution);
            automatic = !in_manual(t);
            if (!automatic && was) manual_u = u + u_span * random.uniform(-0.3, 0.3);
            if (!automatic && random.chance(0.3 * l.Ts / l.T1)) manual_u += u_span * random.uniform(-0.2, 0.2);
            was = automatic;
            if (l.feedforward != 0) further = 0.97 * further + 0.25 * random.normal();
            u = program.step(r, y_read, automatic, manual_u);
            if (l.feedforward != 0 && automatic) u += l.feedforward * u_span * further;
        }
        if (l.row_time == l.Ts ? k % per_sample == 0 : next_row <= t) keep_row();
        walk += l.load_walk * std::sqrt(dt) * random.normal();
        load = walk + (t > load_at ? l.load_step : 0) + (l.feedforward != 0 ? -0.5 * u_span * further : 0);
        queue.push_back(u + load);
        const double w = queue.front();
        queue.pop_front();
        x1 = l.integrating ? x1 + l.K * w * dt : a1 * x1 + (1 - a1) * l.K * w;
        x2 = a2 * x2 + (1 - a2) * x1;
    }
    return out;
}

std::string described(const SimulatedController& l) {
    static constexpr const char* kStructures[] = {"P", "PI", "PID"};
    static constexpr const char* kForms[] = {"ideal", "series", "velocity"};
    static constexpr const char* kFilters[] = {"", ", derivative filter", ", measurement filter"};
    std::string text = kStructures[static_cast<int>(l.structure)];
    text += std::string(" ") + kForms[static_cast<int>(l.form)] + kFilters[static_cast<int>(l.filter)];
    text += ", Ts T/" + std::to_string(static_cast<int>(l.T1 / l.Ts));
    if (l.row_time != l.Ts) text += ", rows " + std::to_string(l.row_time / l.Ts) + " Ts";
    if (l.raw_sensor) text += " of the sensor";
    if (l.manual_phases > 0) text += l.with_mode ? ", manual (mode)" : ", manual";
    if (l.u_high < 1e8) text += ", limits";
    if (l.y_resolution > 0) text += ", converter";
    if (l.y_record_rounding > 0) text += ", y rounded";
    if (l.u_record_rounding > 0) text += ", u rounded";
    if (l.late_by_one_row) text += ", late";
    if (!l.with_set_point) text += ", no r";
    if (l.set_point_steps == 0) text += ", r fixed";
    return text;
}

}  // namespace tunewright::records
