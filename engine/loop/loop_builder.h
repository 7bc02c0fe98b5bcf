// Puts the delay system of a loop (delay_system.h) together from a plant in state space and a controller.
#pragma once

#include <utility>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/loop/delay_system.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// Makes a DelaySystem. Writes rows and entries of the growing system; y and its derivative as linear forms in x and v.
/// It uses plain loops: with Eigen's maps a system of 4 to 11 states takes up to 7 % longer, up to 16 % without a
/// filter.
class LoopBuilder {
public:
    /// `plant` with the dead time L may have states that its input does not reach. Plant and controller must outlive
    /// this.
    LoopBuilder(const Realisation& plant, double L, const ParallelPid& c) : plant_(plant), c_(c) {
        const int filter_states = c.filter.type == FilterType::none                       ? 0
                                  : c.filter.type == FilterType::measurement_second_order ? 2
                                                                                          : 1;
        const bool integral = c.Ki != 0;
        const bool lag = c.setpoint_lag > 0;
        system_.n = plant_.n + filter_states + (integral ? 1 : 0) + (lag ? 1 : 0);
        system_.L = L;
        const auto n = static_cast<std::size_t>(system_.n);
        system_.F.assign(n * n, 0);
        for (auto* vector : {&system_.G, &system_.H, &system_.M, &system_.Y}) vector->assign(n, 0);
        for (int i = 0; i < plant_.n; ++i) {
            for (int j = 0; j < plant_.n; ++j) F(i, j) = plant_.A[index(i * plant_.n + j)];
            system_.G[index(i)] = plant_.B[index(i)];
            system_.Y[index(i)] = plant_.C[index(i)];
        }
        system_.Z = plant_.D;
        filter_ = plant_.n;
        if (integral) system_.integral_state = plant_.n + filter_states;
        if (lag) system_.setpoint_state = system_.n - 1;
    }

    DelaySystem build() {
        switch (c_.filter.type) {
            case FilterType::none: without_filter(); break;
            case FilterType::derivative: derivative_filter(); break;
            case FilterType::measurement_first_order: first_order_filter(); break;
            case FilterType::measurement_second_order: second_order_filter(); break;
        }
        if (const int i = system_.integral_state; i >= 0) {
            system_.H[index(i)] = 1;
            system_.M[index(i)] = c_.Ki;
        }
        system_.R += c_.Kp * c_.b;
        if (system_.setpoint_state >= 0) filter_setpoint();
        return system_;
    }

private:
    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    double& F(int i, int j) { return system_.F[index(i * system_.n + j)]; }

    /// row += factor * y
    void add_y(int row, double factor) {
        for (int j = 0; j < plant_.n; ++j) F(row, j) += factor * plant_.C[index(j)];
        system_.G[index(row)] += factor * plant_.D;
    }
    /// u += factor * y
    void output_y(double factor) {
        for (int j = 0; j < plant_.n; ++j) system_.M[index(j)] += factor * plant_.C[index(j)];
        system_.N += factor * plant_.D;
    }
    /// u += factor * y' with y' = C (A x + B v): then the plant has no direct term.
    void output_y_slope(double factor) {
        for (int j = 0; j < plant_.n; ++j)
            for (int i = 0; i < plant_.n; ++i)
                system_.M[index(j)] += factor * plant_.C[index(i)] * plant_.A[index(i * plant_.n + j)];
        for (int i = 0; i < plant_.n; ++i) system_.N += factor * plant_.C[index(i)] * plant_.B[index(i)];
    }

    void without_filter() {
        output_y(-c_.Kp);
        if (c_.Kd != 0) output_y_slope(-c_.Kd);
        if (system_.integral_state >= 0) add_y(system_.integral_state, -1);
    }

    void derivative_filter() {
        // z' = ((c r - y) - z)/Tf; the derivative is ((c r - y) - z)/Tf.
        const double Tf = c_.filter.Tf;
        add_y(filter_, -1 / Tf);
        F(filter_, filter_) = -1 / Tf;
        system_.H[index(filter_)] = c_.c / Tf;
        output_y(-c_.Kp - c_.Kd / Tf);
        system_.M[index(filter_)] = -c_.Kd / Tf;
        system_.R += c_.Kd * c_.c / Tf;
        if (system_.integral_state >= 0) add_y(system_.integral_state, -1);
    }

    void first_order_filter() {
        // y_f' = (y - y_f)/Tf.
        const double Tf = c_.filter.Tf;
        add_y(filter_, 1 / Tf);
        F(filter_, filter_) = -1 / Tf;
        system_.M[index(filter_)] = -c_.Kp + c_.Kd / Tf;
        output_y(-c_.Kd / Tf);
        if (system_.integral_state >= 0) F(system_.integral_state, filter_) = -1;
    }

    void second_order_filter() {
        // y_f and its scaled slope z = Tf y_f': Tf z'/2 = y - y_f - z.
        const double Tf = c_.filter.Tf;
        F(filter_, filter_ + 1) = 1 / Tf;
        add_y(filter_ + 1, 2 / Tf);
        F(filter_ + 1, filter_) = -2 / Tf;
        F(filter_ + 1, filter_ + 1) = -2 / Tf;
        system_.M[index(filter_)] = -c_.Kp;
        system_.M[index(filter_ + 1)] = -c_.Kd / Tf;
        if (system_.integral_state >= 0) F(system_.integral_state, filter_) = -1;
    }

    /// The filtered set point takes the place of r: r_f' = (r - r_f)/T.
    void filter_setpoint() {
        const int last = system_.setpoint_state;
        for (int i = 0; i < last; ++i) F(i, last) = std::exchange(system_.H[index(i)], 0);
        system_.M[index(last)] = std::exchange(system_.R, 0);
        system_.setpoint_lag = c_.setpoint_lag;
        F(last, last) = -1 / c_.setpoint_lag;
        system_.H[index(last)] = 1 / c_.setpoint_lag;
    }

    const Realisation& plant_;
    const ParallelPid& c_;
    DelaySystem system_;
    int filter_ = 0;
};

}  // namespace tunewright
