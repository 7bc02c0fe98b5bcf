// The programs of tests that a controller runs by itself, executed on simulated plants: how they end, what each fault
// does.
#include "engine/code/experiment/experiment.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <random>

#include "engine/code/interpreter.h"
#include "engine/identification/identify.h"

namespace tunewright::code {
namespace {

using Reason = ExperimentReason;
using Mode = ExperimentMode;

constexpr double kTs = 0.5, kU0 = 40, kY0 = 20, kSafe = 7;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

ExperimentOptions options() {
    return {.Ts = kTs, .u_step = 10, .u_min = 0, .u_max = 100, .y_min = 0, .y_max = 60, .u_safe = kSafe};
}

/// K/(T s + 1) with a dead time of whole calls, u held from call to call: exact.
struct FirstOrder {
    double K = 1, T = 10;
    int late = 4;
    double y = 0;
    std::deque<double> line = {};

    void advance(double u) {
        line.push_back(u);
        if (static_cast<int>(line.size()) <= late) return;
        const double fall = std::exp(-kTs / T);
        y = fall * y + K * (1 - fall) * line.front();
        line.pop_front();
    }
};

/// A program on a plant, call by call.
class Trial {
public:
    Trial(Experiment kind, const ExperimentOptions& options, FirstOrder plant = {}, double noise = 0)
        : program_(*experiment_algorithm(kind, options)),
          plant_(plant),
          noise_(0, noise > 0 ? noise : 1),
          noisy_(noise > 0) {
        for (const Declaration& input : of_role(program_of(kind, options), VariableRole::input))
            program_[input.name] = input.initial;
        program_["u_controller"] = kU0;
        call();  // with start false
        program_["start"] = 1;
    }

    void call(double load = 0) {
        if (!held_) program_["measurement"] = kY0 + plant_.y + (noisy_ ? noise_(engine_) : 0);
        program_["now"] = clock_;
        program_.call();
        plant_.advance(u() - kU0 + load);
        clock_ += kTs;
    }
    /// Calls until the mode or the end.
    void call_until(Mode mode) {
        for (int k = 0; k < 6000 && this->mode() != mode && this->mode() < Mode::done; ++k) call();
        ASSERT_EQ(this->mode(), mode) << "reason " << program_["reason"];
    }
    double& operator[](const char* name) { return program_[name]; }
    double u() { return program_["u"]; }
    Mode mode() { return static_cast<Mode>(static_cast<int>(program_["mode"])); }
    Reason reason() { return static_cast<Reason>(static_cast<int>(program_["reason"])); }
    void hold_measurement(double y) {
        held_ = true;
        program_["measurement"] = y;
    }
    void release_measurement() { held_ = false; }
    void jump_clock(double by) { clock_ += by; }

private:
    static Program program_of(Experiment kind, const ExperimentOptions& options) {
        return *experiment_algorithm(kind, options);
    }
    Interpreter program_;
    FirstOrder plant_;
    std::mt19937 engine_{3};
    std::normal_distribution<> noise_;
    bool noisy_, held_ = false;
    double clock_ = 100;
};

struct Cycle {
    double period, amplitude;
};

/// The limit cycle of a lag T with a dead time L under a relay without hysteresis, whose levels drive y to `up` and to
/// -`down`: y goes on for L after each crossing, then back.
Cycle cycle_of(double up, double down, double T, double L) {
    const double top = up * (1 - std::exp(-L / T)), bottom = down * (1 - std::exp(-L / T));
    return {2 * L + T * std::log(1 + top / down) + T * std::log(1 + bottom / up), (top + bottom) / 2};
}

TEST(RelayProgram, EndsByItselfWithTheCycleOfThePlantAndGivesUBack) {
    for (const double K : {1.0, -2.5})
        for (const Action action : {Action::find, K > 0 ? Action::reverse : Action::direct}) {
            ExperimentOptions asked = options();
            asked.action = action;
            Trial run(Experiment::relay, asked, {.K = K});
            double least = kU0, largest = kU0;
            while (run.mode() < Mode::done) {
                run.call();
                least = std::min(least, run.u());
                largest = std::max(largest, run.u());
            }
            EXPECT_EQ(run.mode(), Mode::done);
            EXPECT_EQ(run.reason(), Reason::settled);
            EXPECT_EQ(run.u(), kU0);
            EXPECT_EQ(run["sign_found"], K > 0 ? 1 : -1);
            EXPECT_DOUBLE_EQ(least, kU0 - 7);
            EXPECT_DOUBLE_EQ(largest, kU0 + 13);
            // A crossing is seen up to a call late.
            const Cycle least_cycle = cycle_of(std::abs(K) * 13, std::abs(K) * 7, 10, 4 * kTs);
            const Cycle most_cycle = cycle_of(std::abs(K) * 13, std::abs(K) * 7, 10, 5 * kTs);
            EXPECT_GT(run["period"], least_cycle.period);
            EXPECT_LT(run["period"], most_cycle.period);
            EXPECT_GT(run["amplitude"], least_cycle.amplitude);
            EXPECT_LT(run["amplitude"], most_cycle.amplitude);
        }
}

TEST(RelayProgram, MeasuresTheNoiseAndKeepsItsBandAboveIt) {
    Trial run(Experiment::relay, options(), {}, 0.2);
    run.call_until(Mode::first_move);
    EXPECT_NEAR(run["noise"], 0.2, 0.08);  // 29 differences
    EXPECT_DOUBLE_EQ(run["hysteresis"], 3 * run["noise"]);
    run.call_until(Mode::done);
    EXPECT_EQ(run.u(), kU0);
}

TEST(RelayProgram, RunsTheCyclesThatAreAskedFor) {
    for (const int cycles : {1, 7}) {
        ExperimentOptions asked = options();
        asked.cycles = cycles;
        Trial run(Experiment::relay, asked);
        run.call_until(Mode::done);
        EXPECT_EQ(run.reason(), Reason::cycles);
        EXPECT_EQ(run["cycles_done"], cycles);
    }
}

TEST(RelayProgram, KeepsTheRateOfUButForAFault) {
    ExperimentOptions asked = options();
    asked.rate_limit = 4;
    Trial run(Experiment::relay, asked);
    for (double last = kU0; run.mode() < Mode::done; last = run.u()) {
        run.call();
        ASSERT_LE(std::abs(run.u() - last), 4 * kTs + 1e-9);
    }
    for (int k = 0; k < 20; ++k) run.call();
    EXPECT_EQ(run.u(), kU0);
    Trial faulty(Experiment::relay, asked);
    faulty.call_until(Mode::test);
    faulty["measurement_ok"] = 0;
    faulty.call();
    EXPECT_EQ(faulty.u(), kSafe);
}

TEST(RelayProgram, TurnsASignThatTheFirstMoveMisled) {
    // (1 - 4 s)/((10 s + 1)(8 s + 1)): y first moves the wrong way.
    Interpreter program(*experiment_algorithm(Experiment::relay, options()));
    for (const char* name : {"measurement_ok", "now", "u_actual"})
        program[name] = name[0] == 'm' ? 1 : name[0] == 'n' ? -1 : 1e30;
    double x1 = 0, x2 = 0;
    program["u_controller"] = kU0;
    program["measurement"] = kY0;
    program["start"] = 0;
    program.call();
    program["start"] = 1;
    for (int k = 0; k < 4000 && program["mode"] < 4; ++k) {
        program["measurement"] = kY0 + x2 - 4 * (x1 - x2) / 8;
        program.call();
        for (int i = 0; i < 100; ++i) {
            x1 += kTs / 100 * (program["u"] - kU0 - x1) / 10;
            x2 += kTs / 100 * (x1 - x2) / 8;
        }
    }
    EXPECT_EQ(program["mode"], 4);
    EXPECT_EQ(program["sign_found"], 1);
}

TEST(BumpProgram, StepsUntilYHasSettledAndBackForAsLong) {
    for (const double step : {10.0, -10.0}) {
        ExperimentOptions asked = options();
        asked.u_step = step;
        Trial run(Experiment::bump, asked);
        run.call_until(Mode::first_move);
        EXPECT_EQ(run.u(), kU0 + step);
        run.call_until(Mode::test);
        EXPECT_EQ(run.u(), kU0);
        EXPECT_NEAR(run["measurement"], kY0 + step, 0.05 * 10);
        const double up = run["up_time"], t = run["t"];
        EXPECT_GT(up, 3 * 10);
        run.call_until(Mode::done);
        EXPECT_NEAR(run["t"] - t, up, 2 * kTs);
        EXPECT_EQ(run.reason(), Reason::settled);
    }
}

TEST(BumpProgram, GoesBackWhenYHasMovedSoFar) {
    ExperimentOptions asked = options();
    asked.y_move = 3;
    Trial run(Experiment::bump, asked, {.K = 100, .T = 1000});  // nearly an integrator
    run.call_until(Mode::test);
    EXPECT_NEAR(run["measurement"], kY0 + 3, 0.6);
}

TEST(ExperimentProgram, IdleItPassesTheControllersUOn) {
    for (const Experiment kind : {Experiment::relay, Experiment::bump}) {
        Trial run(kind, options());
        run["start"] = 0;
        for (const double u : {3.0, 250.0, -8.0}) {
            run["u_controller"] = u;
            run.call();
            EXPECT_EQ(run.u(), u);
            EXPECT_EQ(run["recording"], 0);
        }
    }
}

TEST(ExperimentProgram, EveryCallOfATestIsARow) {
    Trial run(Experiment::relay, options());
    double t = -kTs;
    while (run.mode() < Mode::done) {
        run.call();
        if (run["recording"] == 0) continue;
        EXPECT_NEAR(run["t"] - t, kTs, 1e-9);
        t = run["t"];
        EXPECT_EQ(run["u_last"], run.u());
        EXPECT_EQ(run["y_last"], run["measurement"]);
    }
    EXPECT_EQ(run["recording"], 1);  // the last call too
    run.call();
    EXPECT_EQ(run["recording"], 0);
}

/// The record of a relay test on a plant whose load grows by `drift` u in every call.
Record recorded(const FirstOrder& plant, Action action, double drift) {
    ExperimentOptions asked = options();
    asked.y_min = -500, asked.y_max = 500, asked.action = action;
    Trial run(Experiment::relay, asked, plant);
    Record record;
    for (double load = 0; run.mode() < Mode::done; load += drift) {
        run.call(load);
        if (run["recording"] == 0) continue;
        record.t.push_back(run["t"]);
        record.u.push_back(run.u());
        record.y.push_back(run["y_last"]);
    }
    EXPECT_EQ(run.mode(), Mode::done);
    return record;
}

TEST(RelayProgram, ItsRecordShowsThePlant) {
    struct Case {
        FirstOrder plant;
        Action action;
        double drift, error;
    };
    for (const Case& c : {Case{{.K = 1, .T = 10, .late = 4}, Action::find, 0, 1e-4},
                          Case{{.K = -2, .T = 40, .late = 3}, Action::find, 0, 1e-4},
                          Case{{.K = -1.2, .T = -20, .late = 12}, Action::reverse, 0, 1e-3}}) {  // grows e^20-fold
        const auto model = identify(recorded(c.plant, c.action, c.drift), {}, {});
        ASSERT_TRUE(model) << model.error().message;
        const auto* plant = std::get_if<Fopdt>(&model->plant);
        ASSERT_NE(plant, nullptr) << c.plant.T;
        // For a negative T the plant K/(T s + 1) is written with its own signs.
        EXPECT_NEAR(plant->K, c.plant.K, c.error * std::abs(c.plant.K));
        EXPECT_NEAR(plant->T, c.plant.T, c.error * std::abs(c.plant.T));
        EXPECT_NEAR(plant->L, c.plant.late * kTs, 0.05 * c.plant.late * kTs);
    }
}

TEST(RelayProgram, ALoadThatGrowsGivesNoGainOfTheWrongSign) {
    for (const double drift : {-0.01, -0.006}) {
        const auto model = identify(recorded({.K = 0.5, .T = 24, .late = 18}, Action::reverse, drift), {}, {});
        ASSERT_TRUE(model) << model.error().message;
        for (const Warning& warning : model->warnings)
            EXPECT_FALSE(warning.code == "gain-from-oscillation" && warning.level == WarningLevel::bad)
                << warning.detail;
    }
}

struct Fault {
    const char* name;
    Reason reason;
    void (*cause)(Trial&);
    int calls = 1;  ///< until it can be known
};

std::vector<Fault> faults() {
    return {{"sensor reports a fault", Reason::sensor, [](Trial& r) { r["measurement_ok"] = 0; }},
            {"not a number", Reason::sensor, [](Trial& r) { r.hold_measurement(kNan); }},
            {"infinite", Reason::y_high, [](Trial& r) { r.hold_measurement(std::numeric_limits<double>::infinity()); }},
            {"below its range", Reason::y_low, [](Trial& r) { r.hold_measurement(-0.001); }},
            {"above its range", Reason::y_high, [](Trial& r) { r.hold_measurement(60.001); }},
            {"u lost", Reason::u_refused, [](Trial& r) { r["u_actual"] = kNan; }},
            {"u refused", Reason::u_refused, [](Trial& r) { r["u_actual"] = r.u() + 2; }},
            {"clock forward", Reason::clock, [](Trial& r) { r.jump_clock(10); }},
            {"clock backward", Reason::clock, [](Trial& r) { r.jump_clock(-1); }},
            {"clock stands", Reason::clock, [](Trial& r) { r.jump_clock(-kTs); }},
            {"clock lost", Reason::clock, [](Trial& r) { r.jump_clock(kNan); }},
            {"power lost and back", Reason::restarted, [](Trial& r) { r["powered"] = 0; }},
            {"frozen", Reason::frozen, [](Trial& r) { r.hold_measurement(r["measurement"]); }, 26},
            {"time", Reason::time, [](Trial& r) { r["max_time"] = r["t"]; }}};
}

TEST(ExperimentProgram, AFaultSetsTheSafeValueInTheCallInWhichItIsKnown) {
    for (const Experiment kind : {Experiment::relay, Experiment::bump})
        for (const Fault& fault : faults())
            for (const Mode mode : {Mode::quiet, Mode::first_move, Mode::test}) {
                if (fault.reason == Reason::frozen && mode == Mode::quiet) continue;  // not known before it has moved
                SCOPED_TRACE(std::string(fault.name) + " in mode " + std::to_string(static_cast<int>(mode)));
                Trial run(kind, options(), {}, 0.05);
                run.call_until(mode);
                run.call();
                fault.cause(run);
                int calls = 0;
                while (run.mode() != Mode::stopped && calls < 40) {
                    run.call();
                    ++calls;
                }
                EXPECT_LE(calls, fault.calls);
                EXPECT_EQ(run.reason(), fault.reason);
                EXPECT_EQ(run.u(), kSafe);
                EXPECT_EQ(run["recording"], 0);
                for (int k = 0; k < 5; ++k) {  // it stays so, whatever comes
                    run["measurement_ok"] = 1;
                    run.hold_measurement(kY0);
                    run.call();
                    EXPECT_EQ(run.u(), kSafe);
                }
                run["start"] = 0;  // acknowledged: the controller, which has followed u, goes on without a jump
                run["u_controller"] = run.u();
                run.call();
                EXPECT_EQ(run.u(), kSafe);
                EXPECT_EQ(run.mode(), Mode::idle);
            }
}

TEST(ExperimentProgram, WithoutASafeValueAFaultGivesUBack) {
    ExperimentOptions asked = options();
    asked.u_safe.reset();
    Trial run(Experiment::relay, asked);
    run.call_until(Mode::test);
    run["measurement_ok"] = 0;
    run.call();
    EXPECT_EQ(run.u(), kU0);
}

TEST(ExperimentProgram, APlantThatDoesNotAnswerIsAFault) {
    for (const Experiment kind : {Experiment::relay, Experiment::bump}) {
        ExperimentOptions asked = options();
        asked.max_time = 400;
        Trial run(kind, asked, {.K = 0}, 0.05);
        while (run.mode() < Mode::done) run.call();
        EXPECT_EQ(run.reason(), Reason::no_response);
        EXPECT_EQ(run.u(), kSafe);
    }
}

TEST(ExperimentProgram, TheOperatorEndsItAtOnceWithUAsBefore) {
    for (const Mode mode : {Mode::quiet, Mode::first_move, Mode::test}) {
        Trial run(Experiment::relay, options());
        run.call_until(mode);
        run["start"] = 0;
        run["u_controller"] = run.u();  // it follows
        run.call();
        EXPECT_EQ(run.u(), kU0);
        EXPECT_EQ(run.reason(), Reason::by_operator);
        EXPECT_EQ(run.mode(), Mode::done);  // for the controller, which still follows
        run["u_controller"] = run.u();
        for (int k = 0; k < 3; ++k) {
            run.call();
            EXPECT_EQ(run.u(), kU0);
            EXPECT_EQ(run.mode(), Mode::idle);
        }
        run["start"] = 1;  // and again
        run.call_until(Mode::done);
    }
}

TEST(ExperimentProgram, TheOperatorsEndKeepsTheRateAndModeStaysUntilUIsBack) {
    ExperimentOptions asked = options();
    asked.rate_limit = 4;
    Trial run(Experiment::relay, asked);
    run.call_until(Mode::test);
    for (int k = 0; k < 4; ++k) run.call();
    run["start"] = 0;
    double last = run.u();
    ASSERT_GT(std::abs(last - kU0), 4 * kTs);
    for (int k = 0; k < 20 && run.mode() != Mode::idle; ++k, last = run.u()) {
        run["u_controller"] = last;
        run.call();
        EXPECT_LE(std::abs(run.u() - last), 4 * kTs + 1e-9);
    }
    EXPECT_EQ(run.u(), kU0);
    EXPECT_EQ(run.mode(), Mode::idle);
}

TEST(ExperimentProgram, ItWatchesYUntilTheControllerHasTakenOver) {
    for (const double bad : {60.5, -1.0, kNan}) {
        Trial run(Experiment::relay, options());
        run.call_until(Mode::done);
        for (int k = 0; k < 5; ++k) run.call();
        EXPECT_EQ(run.u(), kU0);
        run.hold_measurement(bad);
        run.call();
        EXPECT_EQ(run.mode(), Mode::stopped);
        EXPECT_EQ(run.u(), kSafe);
    }
}

TEST(ExperimentProgram, AControllersUThatIsNoNumberIsReplacedByTheLastU) {
    Trial run(Experiment::relay, options());
    run["start"] = 0;
    run.call();
    run["u_controller"] = kNan;
    run.call();
    EXPECT_EQ(run.u(), kU0);
    run["start"] = 1;
    run.call_until(Mode::done);
    EXPECT_EQ(run.u(), kU0);
}

TEST(ExperimentProgram, OneFalseValueInTheQuietTimeChangesNeitherLevelNorNoise) {
    for (const double spike : {20.0, -20.0}) {
        Trial run(Experiment::relay, options(), {}, 0.1);
        for (int k = 0; run.mode() < Mode::first_move; ++k) {
            if (k == 10) run.hold_measurement(kY0 + spike);
            if (k == 11) run.release_measurement();
            run.call();
        }
        EXPECT_NEAR(run["noise"], 0.1, 0.05);
        EXPECT_NEAR(run["y0"], kY0, 0.1);
    }
}

TEST(ExperimentProgram, ALevelOutOfReachIsRefusedAtTheStart) {
    for (const auto& [u, kind] : {std::pair{100.0, Experiment::relay},
                                  {0.0, Experiment::relay},
                                  {101.0, Experiment::relay},
                                  {99.5, Experiment::bump},
                                  {-1.0, Experiment::bump}}) {
        Trial run(kind, options());
        run["u_controller"] = u;
        run.call();
        EXPECT_EQ(run.reason(), Reason::settings) << u;
        EXPECT_EQ(run.u(), kSafe);
    }
}

TEST(ExperimentProgram, TheSmallestStepOfYIsItsResolution) {
    Trial run(Experiment::relay, options());
    std::mt19937 engine(5);
    std::bernoulli_distribution flips(0.3);
    for (int k = 0; run.mode() < Mode::first_move && k < 100; ++k) {
        run.hold_measurement(flips(engine) ? 20.1 : 20.0);
        run.call();
    }
    EXPECT_GE(run["hysteresis"], 0.15 - 1e-9);
}

TEST(ExperimentProgram, AFalseOptionIsNamed) {
    const auto where = [](void (*change)(ExperimentOptions&), Experiment kind = Experiment::relay) {
        ExperimentOptions asked = options();
        change(asked);
        const auto program = experiment_algorithm(kind, asked);
        return program ? std::string("none") : program.error().where;
    };
    EXPECT_EQ(where([](auto& o) { o.Ts = 0; }), "sample_time");
    EXPECT_EQ(where([](auto& o) { o.Ts = kNan; }), "sample_time");
    EXPECT_EQ(where([](auto& o) { o.u_step = -1; }), "u_step");
    EXPECT_EQ(where([](auto& o) { o.u_step = -1; }, Experiment::bump), "none");
    EXPECT_EQ(where([](auto& o) { o.u_step = 0; }, Experiment::bump), "u_step");
    EXPECT_EQ(where([](auto& o) { o.asymmetry = 0.9; }), "asymmetry");
    EXPECT_EQ(where([](auto& o) { o.cycles = -1; }), "cycles");
    EXPECT_EQ(where([](auto& o) { o.u_max = 0; }), "u_max");
    EXPECT_EQ(where([](auto& o) { o.y_min = kNan; }), "y_min");
    EXPECT_EQ(where([](auto& o) { o.y_max = -5; }), "y_max");
    EXPECT_EQ(where([](auto& o) { o.rate_limit = -1; }), "rate_limit");
    EXPECT_EQ(where([](auto& o) { o.u_safe = kNan; }), "u_safe");
    EXPECT_EQ(where([](auto& o) { o.u_safe = 101; }), "u_safe");
}

}  // namespace
}  // namespace tunewright::code
