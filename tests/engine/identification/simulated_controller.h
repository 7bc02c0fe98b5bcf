// Records of simulated loops whose controller is known: a program (engine/controller/sampled/sampled_pid.h states its
// sums, written here anew) on a plant of two lags and a dead time, as a historian or a logger keeps it.
#pragma once

#include <string>

#include "engine/identification/record/record.h"

namespace tunewright::records {

enum class ProgramForm { ideal, series, velocity };
enum class ProgramStructure { p, pi, pid };
enum class ProgramFilter { none, derivative, measurement };

/// One loop, all times in its own unit; `random_controller` makes one from a seed.
struct SimulatedController {
    // The plant: K e^(-L s)/((T1 s + 1)(T2 s + 1)), or K e^(-L s)/(s (T2 s + 1)).
    bool integrating = false;
    double K = 1, T1 = 10, T2 = 0, L = 1;
    // The program.
    ProgramForm form = ProgramForm::ideal;
    ProgramStructure structure = ProgramStructure::pi;
    ProgramFilter filter = ProgramFilter::none;
    double Kp = 1, Ti = 10, Td = 0, Tf = 0, b = 1, c = 0;  ///< of the program's own form
    double Ts = 1;
    bool forward = false;  ///< the integral by the forward rule
    double u_low = -1e9, u_high = 1e9;
    // What moves the loop.
    int set_point_steps = 3;
    double step_size = 10;
    bool set_point_ramps = false;
    double load_step = 0, load_walk = 0;  ///< at the plant's input; the walk per square root of time
    double noise = 0;                     ///< of the sensor, white at the program's samples
    int manual_phases = 0;
    double feedforward = 0;    ///< of an unrecorded measured load, added to u
    double gain_by_error = 0;  ///< Kp (1 + gain_by_error |e|): no PID
    // The record.
    double row_time = 1;
    double duration = 1000;
    double y_resolution = 0;       ///< of the converter: what the program reads
    double y_record_rounding = 0;  ///< of the record alone
    double u_record_rounding = 0;
    bool late_by_one_row = false;  ///< u stands one row below the y that it answers
    bool raw_sensor = false;       ///< y of the row's own time in place of the one that the program read last
    bool with_set_point = true;
    bool with_mode = false;

    // The ideal form of the same law, without discretisation.
    double ideal_Kp() const;
    double ideal_Ti() const;
    double ideal_Td() const;
};

SimulatedController random_controller(int seed);

Record recorded(const SimulatedController& loop, int seed);

/// "PI velocity, Ts T/20, rows coarser, limits".
std::string described(const SimulatedController& loop);

}  // namespace tunewright::records
