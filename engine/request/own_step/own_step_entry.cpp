#include "engine/request/own_step/own_step_entry.h"

namespace tunewright {

const char* name_of(OwnStepRefusal refusal) {
    switch (refusal) {
        case OwnStepRefusal::no_time: return "no-time";
        case OwnStepRefusal::equations: return "equations";
        case OwnStepRefusal::no_law: return "no-law";
        case OwnStepRefusal::unstable: return "unstable";
        case OwnStepRefusal::impulse: return "impulse";
    }
    return "no-time";
}

const char* reason_of(OwnStepRefusal refusal) {
    switch (refusal) {
        case OwnStepRefusal::no_time:
            return "The plant is known only by points of its frequency response, so its response over time is "
                   "unknown. Identify a model first.";
        case OwnStepRefusal::equations:
            return "The plant is given by equations, which have their own operating point: give the steps as "
                   "setpoint_step, load_step and actuator.";
        case OwnStepRefusal::no_law: return "The nonlinear integral of this controller is not supported here.";
        case OwnStepRefusal::unstable: return "The loop is unstable.";
        case OwnStepRefusal::impulse:
            return "y jumps with this load, and the derivative without a filter would answer with an impulse. Give "
                   "the controller a filter, or make the load a ramp.";
    }
    return "";
}

}  // namespace tunewright
