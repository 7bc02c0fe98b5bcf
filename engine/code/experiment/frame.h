// The common part of all experiments' programs: the start, the faults, the noise, and u.
#pragma once

#include "engine/code/composer.h"
#include "engine/code/experiment/experiment.h"

namespace tunewright::code {

class ExperimentFrame : protected Composer {
public:
    virtual ~ExperimentFrame() = default;
    Program build();

protected:
    ExperimentFrame(const char* name, const char* title, const ExperimentOptions& options);

    /// Statements of a test's own: in the call that begins it, in the last call of the quiet time, and in each further
    /// call, where it sets `target_` or ends.
    virtual Block begin() = 0;
    virtual Block first() = 0;
    virtual Block move() = 0;
    /// True if the levels cannot be reached from u0.
    virtual Expr impossible() = 0;
    virtual std::vector<std::string> notes() = 0;
    /// Its own notes and those of every experiment.
    static std::vector<std::string> with_common_notes(std::vector<std::string> own);

    Expr is(ExperimentMode mode) const;
    /// True while u is moved or the noise measured.
    Expr runs() const;
    Statement set(ExperimentMode mode) const;
    /// Ends the test with u0, or with the safe value.
    Block end(ExperimentReason reason) const;
    Block fault(ExperimentReason reason) const;
    /// to = |x|.
    static Block take_size(const Expr& to, const Expr& x);

    const ExperimentOptions options_;
    Expr y_ = input("measurement", "y");
    Expr u_controller_ = input("u_controller", "u of the loop's own controller, or the operator's");
    Expr start_ = input("start", "rises: begins a test; falls: ends it, or acknowledges its end", Type::boolean);
    Expr u_ = output("u", "to the actuator, and to the controller, which follows it while mode is not 0");
    Expr mode_ = output("mode", "0 idle, 1 quiet, 2 first move, 3 test, 4 done, 5 stopped by a fault", Type::integer);
    Expr reason_ = output("reason", "why the last test ended", Type::integer);
    Expr recording_ = output("recording", "true: t, u and y of this call are a row of the record", Type::boolean);
    // Set by the constructor.
    Expr Ts_ = 0, u_step_ = 0, u_min_ = 0, u_max_ = 0, max_time_ = 0, u0_ = 0, y0_ = 0, t_ = 0, noise_ = 0,
         hysteresis_ = 0, target_ = 0, t_phase_ = 0, y_last_ = 0;

private:
    void declare_settings();
    void declare_states();
    void add_start();
    void add_stop();
    void add_faults();
    void add_noise();
    void add_output();
    Block begin_all();
    Block end_of_quiet();
    /// A fault where `where` and `wrong` hold.
    void check(const Expr& where, const Expr& wrong, ExperimentReason reason);

    Expr ok_ = 0, now_ = 0, u_actual_ = 0;
    Expr y_min_ = 0, y_max_ = 0, u_safe_ = 0, rate_limit_ = 0, quiet_time_ = 0, hysteresis_min_ = 0, frozen_time_ = 0,
         longest_gap_ = 0, u_tolerance_ = 0;
    Expr powered_ = 0, start_last_ = 0, mode_now_ = 0, reason_now_ = 0, now_last_ = 0, timed_ = 0, u_last_ = 0;
    Expr calls_ = 0, sum_ = 0, highest_ = 0, lowest_ = 0, largest_ = 0, second_ = 0, changes_ = 0, least_change_ = 0,
         unchanged_ = 0, run_ = 0, longest_run_ = 0;
    Expr given_ = 0, running_ = 0, watched_ = 0, dt_ = 0, change_ = 0, difference_ = 0;
};

}  // namespace tunewright::code
