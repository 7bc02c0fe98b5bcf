// PID_v1 1.2.1 and QuickPID 3.1.5 for sketches that are read: the published types of constructors, setters, modes and
// constants. Each call prints one line: its name, and its arguments as numbers or as the names of the variables.
#pragma once

#include <cstdint>
#include <cstdio>

void print_variable(const void* variable);

template <class Number>
void print_argument(Number argument) {
    std::printf(" %.9g", static_cast<double>(argument));
}
template <class Number>
void print_argument(Number* variable) {
    print_variable(variable);
}

template <class... Arguments>
void record(const char* call, Arguments... arguments) {
    std::printf("%s", call);
    (print_argument(arguments), ...);
    std::printf("\n");
}

#define AUTOMATIC 1
#define MANUAL 0
#define DIRECT 0
#define REVERSE 1
#define P_ON_M 0
#define P_ON_E 1

class PID {
public:
    PID(double* input, double* output, double* setpoint, double Kp, double Ki, double Kd, int POn, int direction) {
        record("PID", input, output, setpoint, Kp, Ki, Kd, POn, direction);
    }
    PID(double* input, double* output, double* setpoint, double Kp, double Ki, double Kd, int direction)
        : PID(input, output, setpoint, Kp, Ki, Kd, P_ON_E, direction) {}

    void SetMode(int mode) { record("SetMode", mode); }
    void SetOutputLimits(double low, double high) { record("SetOutputLimits", low, high); }
    void SetTunings(double Kp, double Ki, double Kd) { record("SetTunings", Kp, Ki, Kd); }
    void SetTunings(double Kp, double Ki, double Kd, int POn) { record("SetTunings", Kp, Ki, Kd, POn); }
    void SetControllerDirection(int direction) { record("SetControllerDirection", direction); }
    void SetSampleTime(int milliseconds) { record("SetSampleTime", milliseconds); }
};

class QuickPID {
public:
    enum class Control : std::uint8_t { manual, automatic, timer, toggle };
    enum class Action : std::uint8_t { direct, reverse };
    enum class pMode : std::uint8_t { pOnError, pOnMeas, pOnErrorMeas };
    enum class dMode : std::uint8_t { dOnError, dOnMeas };
    enum class iAwMode : std::uint8_t { iAwCondition, iAwClamp, iAwOff };

    QuickPID(float* input, float* output, float* setpoint, float Kp, float Ki, float Kd, pMode p, dMode d, iAwMode i,
             Action action) {
        record("QuickPID", input, output, setpoint, Kp, Ki, Kd, p, d, i, action);
    }
    QuickPID(float* input, float* output, float* setpoint, float Kp, float Ki, float Kd, Action action)
        : QuickPID(input, output, setpoint, Kp, Ki, Kd, pMode::pOnError, dMode::dOnMeas, iAwMode::iAwCondition,
                   action) {}

    void SetMode(Control mode) { record("SetMode", mode); }
    void SetOutputLimits(float low, float high) { record("SetOutputLimits", low, high); }
    void SetTunings(float Kp, float Ki, float Kd) { record("SetTunings", Kp, Ki, Kd); }
    void SetTunings(float Kp, float Ki, float Kd, pMode p, dMode d, iAwMode i) {
        record("SetTunings", Kp, Ki, Kd, p, d, i);
    }
    void SetControllerDirection(Action action) { record("SetControllerDirection", action); }
    void SetSampleTimeUs(std::uint32_t microseconds) { record("SetSampleTimeUs", microseconds); }
};
