#include "tests/records/made_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "tests/records/record_form.h"

namespace tunewright::records {
namespace {

/// The move of u: its level at a row, or at a step of the simulation, from the measurement there.
using Operator = std::function<double(int place, double y)>;

struct Plan {
    int rows = 0;
    double dt = 0;
    Operator u;
    std::vector<double> r;   ///< set point, if there is one
    bool each_step = false;  ///< u is computed at every step instead of every row
};

/// Rows at which a test without feedback moves u.
struct Move {
    int row;
    double level;
};

Operator by_moves(std::vector<Move> moves) {
    return [moves = std::move(moves)](int row, double) {
        double level = 0;
        for (const Move& move : moves) {
            if (row >= move.row) level = move.level;
        }
        return level;
    };
}

/// The times of a test, in rows.
struct Scale {
    double dt;
    int settling, rest;
};

Scale some_scale(const MadeRecord& made, Random& random) {
    const double settling = made.plant.settling();
    const int rows = static_cast<int>(random.spread(60, 500));
    const bool little = made.test == Test::step_little_rest;
    return {settling / rows, rows,
            little ? random.below(9) : std::max(6, static_cast<int>(rows * random.uniform(0.1, 0.5)))};
}

Plan open_steps(MadeRecord& made, const Scale& s, Random& random) {
    std::vector<Move> moves;
    int row = std::max(1, s.rest);
    const double sign = random.chance(0.3) ? -1 : 1;
    auto wait = [&](double low, double high) {
        row += std::max(2, static_cast<int>(s.settling * random.uniform(low, high)));
    };
    switch (made.test) {
        case Test::bump:
            moves.push_back({row, sign});
            wait(0.4, 1.2);
            moves.push_back({row, 0});
            wait(0.8, 1.5);
            break;
        case Test::staircase_between:
        case Test::staircase: {
            double level = 0;
            for (int k = 3 + random.below(3); k > 0; --k) {
                level += random.chance(0.7) ? random.uniform(0.3, 0.6) : -random.uniform(0.3, 0.6);
                moves.push_back({row, sign * level});
                wait(0.5, 1.2);
            }
            break;
        }
        case Test::prbs: {
            const int clock = std::max(2, static_cast<int>(s.settling * random.uniform(0.08, 0.3)));
            const int end = row + static_cast<int>(s.settling * random.uniform(4, 6));
            for (double level = 1; row < end; row += clock * (1 + random.below(3)), level = -level)
                moves.push_back({row, level});
            row = end;
            break;
        }
        case Test::ramp: {
            const int length = static_cast<int>(s.settling * random.uniform(0.3, 1.5));
            for (int k = 0; k <= length; ++k) moves.push_back({row + k, sign * k / length});
            row += length;
            wait(1, 1.6);
            break;
        }
        default:
            moves.push_back({row, sign});
            made.cut_short = random.chance(0.12);
            if (made.cut_short)
                wait(0.35, 0.8);
            else
                wait(1, 2.2);
    }
    return {row, s.dt, by_moves(std::move(moves)), {}};
}

Plan relay_test(const MadeRecord& made, const Scale& s, Random& random) {
    const double bias = random.chance(0.5) ? random.uniform(0.1, 0.4) : 0, sign = made.plant.K > 0 ? 1 : -1;
    // The signal for the relay: above the noise, below the effect of half an oscillation.
    const double moved = made.plant.integrating ? std::abs(made.plant.K) * (made.plant.L + made.plant.lag_sum())
                                                : std::abs(made.plant.K);
    const double hysteresis = moved * std::max(random.uniform(0.02, 0.1), 4 * made.noise_std);
    const int rest = s.rest;
    bool up = true;
    Plan plan{rest + 5 * s.settling, s.dt, nullptr, {}};
    plan.u = [=](int row, double y) mutable {
        if (row < rest) return 0.0;
        if (up && sign * y > hysteresis) up = false;
        if (!up && sign * y < -hysteresis) up = true;
        return (up ? 1 : -1) + bias;
    };
    return plan;
}

/// A PI controller by lambda tuning for a rough first-order model of the plant, in the position form.
Plan feedback(const MadeRecord& made, const Scale& s, Random& random) {
    const TruePlant& plant = made.plant;
    const double lags = plant.lag_sum(), dead = plant.L + 0.4 * lags + std::max(0.0, -plant.b) + s.dt;
    double Kp = 0, Ti = 0;
    if (plant.integrating) {
        const double close = 2 * (plant.L + lags);
        Kp = 1 / (plant.K * (close + plant.L + lags));
        Ti = 4 * (close + plant.L + lags);
    } else {
        Ti = std::max(0.6 * lags, 0.3 * dead);
        Kp = 0.6 * Ti / (plant.K * (dead + random.uniform(1, 2) * dead));
    }
    const bool moves = made.test == Test::closed_setpoints;
    const double size = plant.integrating ? std::abs(plant.K) * (plant.L + lags) : std::abs(plant.K);
    Plan plan{s.rest + 6 * s.settling, s.dt, nullptr, {}};
    std::vector<double> r(static_cast<std::size_t>(plan.rows), 0.0);
    int next = s.rest;
    double level = 0;
    for (int row = 0; row < plan.rows; ++row) {
        if (moves && row == next) {
            level = size * random.uniform(-1, 1);
            next += static_cast<int>(s.settling * random.uniform(0.8, 1.6));
        }
        r[static_cast<std::size_t>(row)] = level;
    }
    double sum = 0;
    plan.u = [=, dt = s.dt](int row, double y) mutable {
        const double e = r[static_cast<std::size_t>(row)] - y;
        sum += Kp / Ti * e * dt;
        return Kp * e + sum;
    };
    if (moves) plan.r = r;
    return plan;
}

/// A test that moves u at rows, with the moves shifted within them: all by one phase, or each by its own.
Plan between_rows(Plan plan, Random& random) {
    const int phase = random.chance(0.5) ? random.below(kFine) : -1;
    std::vector<int> earlier;
    for (int row = 0; row < plan.rows; ++row) earlier.push_back(phase >= 0 ? phase : random.below(kFine));
    plan.u = [of_row = plan.u, earlier = std::move(earlier)](int step, double y) {
        const int row = step / kFine, next = std::min(row + 1, static_cast<int>(earlier.size()) - 1);
        const int left = next * kFine - step;
        return of_row(left <= earlier[static_cast<std::size_t>(next)] ? next : row, y);
    };
    plan.each_step = true;
    return plan;
}

/// A relay that samples at every step, or once a row with some phase.
Plan relay_between_rows(Plan plan, Random& random) {
    const int phase = random.chance(0.5) ? random.below(kFine) : -1;
    double level = 0;
    plan.u = [of_row = plan.u, phase, level](int step, double y) mutable {
        if (phase < 0 || step % kFine == phase) level = of_row(step / kFine, y);
        return level;
    };
    plan.each_step = true;
    return plan;
}

Plan make_plan(MadeRecord& made, const Scale& scale, Random& random) {
    switch (made.test) {
        case Test::relay: return relay_test(made, scale, random);
        case Test::relay_between: return relay_between_rows(relay_test(made, scale, random), random);
        case Test::staircase_between: return between_rows(open_steps(made, scale, random), random);
        case Test::closed_setpoints:
        case Test::closed_regulation: return feedback(made, scale, random);
        default: return open_steps(made, scale, random);
    }
}

/// Signals added to y and to the plant's input, row by row; `size`: the effect of a unit of u.
struct Disturbance {
    std::vector<double> on_y, load;
};

Disturbance make_disturbance(const MadeRecord& made, const Plan& plan, double size, Random& random) {
    Disturbance d;
    const double white = size * made.noise_std, slow = plan.dt / made.plant.settling();
    const double pole = random.uniform(0.8, 0.97),
                 walk = made.noise == Noise::drifting_load ? 0.02 * std::sqrt(slow) : 0;
    double state = random.normal(), load = 0;
    int next_load = static_cast<int>(random.uniform(0.2, 1) * made.plant.settling() / plan.dt);
    for (int row = 0; row < plan.rows; ++row) {
        const double fresh = random.normal();
        state = made.noise == Noise::coloured ? pole * state + std::sqrt(1 - pole * pole) * fresh : fresh;
        d.on_y.push_back(white * state + size * made.plant.drift * row * slow);
        load += walk * random.normal();
        if (made.test == Test::closed_regulation && row == next_load) {
            load += random.uniform(-0.5, 0.5);
            next_load += static_cast<int>(random.uniform(0.5, 2) * made.plant.settling() / plan.dt);
        }
        d.load.push_back(load);
    }
    return d;
}

/// `moves`: each change of u between rows, in time.
Record run(const MadeRecord& made, ActuatedPlant& process, const Plan& plan, const Disturbance& d, double size,
           std::vector<std::pair<double, double>>& moves) {
    Record record;
    record.r = plan.r;
    for (int row = 0; row < plan.rows; ++row) {
        const double added = d.on_y[static_cast<std::size_t>(row)];
        const double measured = on_grid(process.y() + added, size * made.plant.grid);
        double u = plan.each_step ? plan.u(row * kFine, measured) : plan.u(row, measured);
        record.t.push_back(plan.dt * row);
        record.u.push_back(u);
        record.y.push_back(measured);
        for (int k = 0; k < kFine; ++k) {
            if (plan.each_step && k > 0) {
                const double now = plan.u(row * kFine + k, process.y() + added);
                if (now != u) moves.emplace_back(plan.dt * (row + static_cast<double>(k) / kFine), now);
                u = now;
            }
            process.advance(u, d.load[static_cast<std::size_t>(row)]);
        }
    }
    return record;
}

/// The record with a row of u alone for each move.
Record told(const Record& record, const std::vector<std::pair<double, double>>& moves) {
    Record with;
    std::size_t j = 0;
    for (std::size_t i = 0; i < record.t.size(); ++i) {
        for (; j < moves.size() && moves[j].first < record.t[i]; ++j) {
            with.t.push_back(moves[j].first);
            with.u.push_back(moves[j].second);
            with.y.push_back(std::numeric_limits<double>::quiet_NaN());
        }
        with.t.push_back(record.t[i]);
        with.u.push_back(record.u[i]);
        with.y.push_back(record.y[i]);
    }
    for (const FurtherInput& input : record.d) {
        FurtherInput& held = with.d.emplace_back(FurtherInput{input.name, {}});
        std::size_t i = 0;
        for (const double t : with.t) {
            while (i + 1 < record.t.size() && record.t[i + 1] <= t) ++i;
            held.values.push_back(input.values[i]);
        }
    }
    return with;
}

/// Converts to the user's units: a level, a slope for u, a start of time.
void into_units(MadeRecord& made, double u_level, double u_step, double y_level, double t_start) {
    for (Record* record : {&made.record, &made.earlier, made.with_moves ? &*made.with_moves : nullptr}) {
        if (record == nullptr) continue;
        for (double& u : record->u) u = u_level + u_step * u;
        for (double& y : record->y) y += y_level;
        for (double& r : record->r) r += y_level;
        for (double& t : record->t) t += t_start;
    }
    made.plant.K /= u_step;
}

}  // namespace

const char* name_of(Test test) {
    static constexpr const char* kNames[] = {
        "step, little rest",  "step",          "bump", "staircase", "prbs", "ramp", "relay", "set points", "regulation",
        "staircase, between", "relay, between"};
    return kNames[static_cast<int>(test)];
}

const char* name_of(Noise noise) {
    static constexpr const char* kNames[] = {"none",     "white",        "coloured",        "drifting load",
                                             "outliers", "missing rows", "irregular times", "logged on change"};
    return kNames[static_cast<int>(noise)];
}

std::string MadeRecord::text() const {
    char line[400];
    std::string lags;
    for (const double T : plant.lags) {
        std::snprintf(line, sizeof line, " %.3g", T);
        lags += line;
    }
    std::snprintf(
        line, sizeof line, "%s, %s, %s %.2g%s: K %.4g L %.3g lags%s osc %.3g/%.2g b %.3g%s, %zu rows of %.3g s",
        records::name_of(plant.family), records::name_of(test), records::name_of(noise), noise_std,
        cut_short ? " (cut short)" : "", plant.K, plant.L, lags.c_str(), plant.T_osc, plant.zeta, plant.b,
        plant.integrating ? " /s" : "", record.t.size(), record.t.size() > 1 ? record.t[1] - record.t[0] : 0.0);
    return line;
}

MadeRecord make_record(std::uint64_t seed, Form form) {
    const int i = static_cast<int>(seed % (kFamilies * kTests * kNoises));
    return make_record(seed, static_cast<Family>(i % kFamilies), static_cast<Test>(i / kFamilies % kTests),
                       static_cast<Noise>(i / (kFamilies * kTests)), form);
}

MadeRecord make_record(std::uint64_t seed, Family family, Test test, Noise noise, Form form) {
    Random random(seed), of_form(seed + 1'000'003ULL * (1 + static_cast<std::uint64_t>(form)));
    MadeRecord made;
    made.seed = seed, made.plant = make_plant(family, random), made.test = test, made.noise = noise, made.form = form;
    if (noise != Noise::none) made.noise_std = random.spread(0.001, 0.03);
    const Scale scale = some_scale(made, random);
    const Plan plan = make_plan(made, scale, random);
    const TruePlant& plant = made.plant;
    const double size = std::abs(plant.K) * (plant.integrating ? plant.L + plant.lag_sum() : 1);
    Disturbance disturbance = make_disturbance(made, plan, size, random);
    ActuatedPlant process(plant, plan.dt);
    if (form == Form::several_runs || form == Form::countdown)
        made.earlier = earlier_run(made, process, scale.dt, scale.settling, size, of_form);
    std::optional<FurtherInput> second;
    if (form == Form::two_inputs) second = second_input(made, plan.dt, size, disturbance.on_y, of_form);
    std::vector<std::pair<double, double>> moves;
    made.record = run(made, process, plan, disturbance, size, moves);
    if (second) made.record.d.push_back(std::move(*second));
    log_rows(made.noise, made.noise_std, size, made.record, random);
    if (plan.each_step) made.with_moves = told(made.record, moves);
    into_units(made, random.uniform(-50, 100), random.spread(0.1, 30), size * random.uniform(-10, 10),
               random.chance(0.5) ? 0 : random.uniform(0, 1e5));
    return made;
}

}  // namespace tunewright::records
