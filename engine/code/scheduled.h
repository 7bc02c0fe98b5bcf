// A controller's program whose settings follow a schedule: the same program (algorithm.h), with one more input, the
// scheduling variable, from which each call computes Kp, Ti, Td, Tf and b before all else.
//
// Settings that move between two calls do not move u (algorithm.h), so the program is bumpless at rows and between.
#pragma once

#include <string>

#include "engine/code/algorithm.h"
#include "engine/controller/schedule/schedule.h"

namespace tunewright::code {

/// What the input of the scheduling variable is called in the programs.
constexpr const char* kSchedulingInput = "scheduling";

/// The row from which what is fixed in the program comes (tracking time, a proposed sample time, whether there is a
/// derivative and a filter): the one with the shortest Ti, of those with a derivative where any has one.
const ScheduleRow& leading_row(const Schedule& schedule);

/// `law`: its rules and sample time; its gains are taken from the leading row. `named`: "level in cm", for the reader.
/// Rows: times in seconds. Errors: those of pid_algorithm; unsupported for a velocity form, for a Kp that changes its
/// sign, and for rows of which some have a filter and others none.
Expected<Program> scheduled_algorithm(const Schedule& schedule, const SampledPid& law,
                                      const CodeOptions& options, const std::string& named);

}  // namespace tunewright::code
