// The parameters of a program: options of the call and of the command, combined with the result and its request.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "api/chosen_entry.h"
#include "api/code/code.h"
#include "api/contract/controller.h"
#include "api/contract/device/code_question.h"
#include "api/describe/description.h"
#include "engine/code/algorithm.h"
#include "engine/code/print.h"

namespace tunewright::api {

/// An object of the words: texts that are numbers become numbers; a text that the contract refuses stays as typed, so
/// that its error can quote it. A word that is given twice is a fault.
Json json_of(const CodeWords& words, Reader& reader);

/// The parameters as typed, what they leave out from the request (of a structure from `sampled`, else the rules of
/// `implement`), and the units of the result: all read before anything is computed.
struct AskedCode {
    CodeQuestion question;
    double unit = 1;  ///< seconds in the result's unit of time
};
AskedCode read_asked(const CodeWords& words, const ChosenEntry& found, Reader& reader);

/// The controller as it stands in an answer; a nonlinear one with the range of errors for which it was designed.
Controller read_controller(const Json& controller, Reader& reader);

struct SampleTime {
    double seconds = 0;
    std::string origin;  ///< for the head comment
};

/// The sample time: as asked for, else as in the request's `sampled` or `implement`, of a list its first, else from the
/// controller's own times (gains with their times in seconds), the design's `longest_sample_time`, of an entry or a
/// schedule, if it has one, and the shortest lag, in seconds, of what stands next to the controller in a structure. A
/// fault of `sample_time` if there is none.
std::variant<SampleTime, Problem> sample_time_of(const AskedCode& asked, const Json& request, const ParallelPid& gains,
                                                 const Json& design,
                                                 double shortest_lag = std::numeric_limits<double>::infinity());

/// The law with times in seconds; its sample time is still to be set.
SampledPid law_of(const AskedCode& asked, const ParallelPid& gains);
code::CodeOptions options_of(const AskedCode& asked, const Json& result);

}  // namespace tunewright::api
