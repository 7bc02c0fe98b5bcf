#include "engine/error.h"

namespace tunewright {

const char* to_string(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::invalid_argument: return "invalid-argument";
        case ErrorKind::unsupported: return "unsupported";
        case ErrorKind::not_identifiable: return "not-identifiable";
        case ErrorKind::unstable_plant: return "unstable-plant";
        case ErrorKind::no_feasible_controller: return "no-feasible-controller";
        case ErrorKind::unbounded_optimum: return "unbounded-optimum";
        case ErrorKind::cancelled: return "cancelled";
        case ErrorKind::timeout: return "timeout";
        case ErrorKind::numerical_failure: return "numerical-failure";
    }
    return "numerical-failure";
}

}  // namespace tunewright
