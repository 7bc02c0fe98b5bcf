// An error as a value: a kind for programs, a place and a sentence for people.
#pragma once

#include <map>
#include <string>

namespace tunewright {

/// Kinds are named for what the caller can do next, not for where the error happened.
enum class ErrorKind {
    invalid_argument,        ///< a value that was given is wrong: `where` names it
    unsupported,             ///< a valid request that this method or plant cannot serve: choose another
    not_identifiable,        ///< the record does not determine a model
    unstable_plant,          ///< no controller of the requested kind stabilises the plant
    no_feasible_controller,  ///< no controller meets the limits: relax them (the sentence says how far)
    unbounded_optimum,       ///< the optimum is unbounded: fix a filter or limit Mks
    not_representable,       ///< a product cannot represent this controller: take the nearest, or tune under its limits
    cancelled,               ///< the caller asked to stop
    timeout,                 ///< the time allowed has run out
    numerical_failure,       ///< the computation could not be finished to its accuracy
};

/// The kind's code, e.g. "no-feasible-controller".
inline const char* to_string(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::invalid_argument: return "invalid-argument";
        case ErrorKind::unsupported: return "unsupported";
        case ErrorKind::not_identifiable: return "not-identifiable";
        case ErrorKind::unstable_plant: return "unstable-plant";
        case ErrorKind::no_feasible_controller: return "no-feasible-controller";
        case ErrorKind::unbounded_optimum: return "unbounded-optimum";
        case ErrorKind::not_representable: return "not-representable";
        case ErrorKind::cancelled: return "cancelled";
        case ErrorKind::timeout: return "timeout";
        case ErrorKind::numerical_failure: return "numerical-failure";
    }
    return "numerical-failure";
}

struct Error {
    ErrorKind kind = ErrorKind::numerical_failure;
    std::string where;    ///< path inside the request, slash separated, e.g. "plant/L"; empty if none
    std::string message;  ///< one or two sentences: name, value, rule, cure
    std::map<std::string, double> cure =
        {};  ///< options of the method, by name, with which it would work; empty: unknown
};

}  // namespace tunewright
