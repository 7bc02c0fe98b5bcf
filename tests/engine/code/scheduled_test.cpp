// The program with a schedule: executed directly, and compared with the controller of reference.h, with settings
// interpolated here for each call.
#include "engine/code/algorithm.h"

#include <gmock/gmock.h>

#include <random>

#include "tests/engine/code/reference.h"

namespace tunewright::code {
namespace {

Schedule schedule_of(Interpolation how, double sign = 1, double Tf = 0) {
    return {.interpolation = how,
            .hysteresis = how == Interpolation::steps ? 4.0 : 0.0,
            .rows = {{.at = 20, .Kp = 0.8 * sign, .Ti = 9, .Td = 1.5, .Tf = Tf, .b = 1},
                     {.at = 40, .Kp = 1.6 * sign, .Ti = 5, .Td = 0.5, .Tf = 2 * Tf, .b = 0.6},
                     {.at = 90, .Kp = 3.0 * sign, .Ti = 4, .Td = 0, .Tf = 3 * Tf, .b = 0}}};
}

SampledPid sampled(double Ts) {
    SampledPid law;
    law.Ts = Ts;
    return law;
}

Program scheduled_program(const Schedule& schedule, const CodeOptions& options = {}) {
    auto program = scheduled_algorithm(schedule, sampled(0.5), options, "load in %");
    EXPECT_TRUE(program) << (program ? "" : program.error().message);
    return program ? *program : Program{};
}

/// The rows in use as documented. With `steps` the next row is used half the hysteresis above its place, and the
/// previous one half the hysteresis below.
class Rows {
public:
    explicit Rows(const Schedule& schedule) : schedule_(schedule) {}

    ScheduleRow at(double x) {
        const auto& rows = schedule_.rows;
        if (schedule_.interpolation == Interpolation::steps) {
            while (row_ < 2 && x > rows[row_ + 1].at + 2) ++row_;
            while (row_ > 0 && x < rows[row_].at - 2) --row_;
            return rows[row_];
        }
        if (x <= 20) return rows[0];
        if (x >= 90) return rows[2];
        const auto& a = x < 40 ? rows[0] : rows[1];
        const auto& b = x < 40 ? rows[1] : rows[2];
        const double s = (x - a.at) / (b.at - a.at);
        const bool gains = schedule_.interpolation == Interpolation::linear_in_gains;
        return {x,
                (1 - s) * a.Kp + s * b.Kp,
                gains ? 1 / ((1 - s) / a.Ti + s / b.Ti) : (1 - s) * a.Ti + s * b.Ti,
                (1 - s) * a.Td + s * b.Td,
                (1 - s) * a.Tf + s * b.Tf,
                (1 - s) * a.b + s * b.b};
    }

private:
    Schedule schedule_;
    std::size_t row_ = 0;
};

Gains gains_of(const ScheduleRow& row) { return {row.Kp, row.Kp / row.Ti, row.Kp * row.Td, row.b}; }

constexpr Interpolation kAll[] = {Interpolation::steps, Interpolation::linear_in_gains, Interpolation::linear_in_times};

TEST(ScheduledProgram, ComputesTheLawWithTheSettingsOfThePlaceThroughLimitsAndManual) {
    for (const Interpolation how : kAll)
        for (const double sign : {1.0, -1.0})
            for (const AntiWindup anti_windup : {AntiWindup::back_calculation, AntiWindup::clamping}) {
                const Schedule schedule = schedule_of(how, sign);
                const CodeOptions options{.anti_windup = anti_windup, .u_min = 0, .u_max = 100, .rate_limit = 40};
                const Program program = scheduled_program(schedule, options);
                Machine machine(program);
                SampledPid law = sampled(0.5);
                law.gains = to_parallel(controller_of(leading_row(schedule)));
                Reference reference(law, options, false, machine.has("Tt") ? machine["Tt"] : 1);
                Rows rows(schedule);
                std::mt19937 random(7);
                std::normal_distribution<double> noise;
                double plant = 50, u = 0;
                for (int k = 0; k < 1500; ++k) {
                    const double place = 55 + 50 * std::sin(0.013 * k) + 0.5 * noise(random);
                    machine["scheduling"] = place;
                    const double r = (k / 300) % 2 ? 62 : 45, y = plant + 0.2 * noise(random);
                    const bool manual = k < 7 || (k / 250) % 5 == 3;
                    u = machine.step(r, y, manual, 30);
                    ASSERT_NEAR(u, reference.step(r, y, manual, 30, gains_of(rows.at(place))), 1e-9)
                        << "interpolation " << int(how) << " sign " << sign << " call " << k;
                    plant += 0.05 * ((sign < 0 ? 60 - u : u) + 10 - plant);
                }
            }
}

TEST(ScheduledProgram, AgreesWithWhatTheDesignComputesBetweenRowsAndMovesItsFilterToo) {
    for (const Interpolation how : {Interpolation::linear_in_gains, Interpolation::linear_in_times}) {
        const Schedule schedule = schedule_of(how, 1, 0.4);
        const Program program = scheduled_program(schedule);
        Machine machine(program);
        for (double place = 0; place <= 120; place += 1.7) {
            machine["scheduling"] = place;
            machine.step(1, 0);
            const IdealPid design = settings_at(schedule, place);
            EXPECT_NEAR(machine["Kp"], design.Kp, 1e-12);
            EXPECT_NEAR(machine["Ti"], design.Ti, 1e-12);
            EXPECT_NEAR(machine["Td"], design.Td, 1e-12);
            EXPECT_NEAR(machine["Tf"], design.filter.Tf, 1e-12);
            EXPECT_NEAR(machine["b"], design.b, 1e-12);
        }
    }
}

TEST(ScheduledProgram, DoesNotMoveItsOutputAtRestWhileSettingsMove) {
    for (const Interpolation how : kAll) {
        const Program program = scheduled_program(schedule_of(how));
        Machine machine(program);
        machine["scheduling"] = 10;
        const double u = machine.step(40, 40, true, 33);
        for (double place = 10; place < 100; place += 0.9) {
            machine["scheduling"] = place;
            EXPECT_NEAR(machine.step(40, 40), u, 1e-12) << place;
        }
    }
}

TEST(ScheduledProgram, TellsWhatItCannotFollow) {
    const auto told = [](const Schedule& schedule, const SampledPid& law) {
        const auto program = scheduled_algorithm(schedule, law, {}, "load");
        return program ? std::string("nothing") : program.error().message;
    };
    SampledPid velocity = sampled(1);
    velocity.velocity = true;
    EXPECT_THAT(told(schedule_of(Interpolation::steps), velocity), testing::HasSubstr("position"));
    Schedule mixed = schedule_of(Interpolation::linear_in_gains);
    mixed.rows[1].Tf = 0.3;
    EXPECT_THAT(told(mixed, sampled(1)), testing::HasSubstr("every row a Tf"));
    mixed.rows[1] = {.at = 40, .Kp = -1, .Ti = 3};
    EXPECT_THAT(told(mixed, sampled(1)), testing::HasSubstr("changes its sign"));
    EXPECT_THAT(told(schedule_of(Interpolation::steps), sampled(0)), testing::HasSubstr("sample_time"));
}

}  // namespace
}  // namespace tunewright::code
