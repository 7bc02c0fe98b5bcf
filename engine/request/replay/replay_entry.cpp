#include "engine/request/replay/replay_entry.h"

namespace tunewright {

const char* name_of(ReplayRefusal refusal) {
    switch (refusal) {
        case ReplayRefusal::manual: return "manual";
        case ReplayRefusal::manual_rows: return "manual-rows";
        case ReplayRefusal::feedback: return "feedback";
        case ReplayRefusal::no_set_point: return "no-set-point";
        case ReplayRefusal::doubtful_model: return "doubtful-model";
        case ReplayRefusal::unknown_region: return "unknown-region";
        case ReplayRefusal::no_error: return "no-error";
        case ReplayRefusal::no_law: return "no-law";
        case ReplayRefusal::coarse_rows: return "coarse-rows";
        case ReplayRefusal::unstable: return "unstable";
        case ReplayRefusal::wide_band: return "wide-band";
    }
    return "manual";
}

const char* reason_of(ReplayRefusal refusal) {
    switch (refusal) {
        case ReplayRefusal::manual:
            return "The record shows no controller in automatic, so it has no control error to compare with. Send a "
                   "record of normal operation in automatic.";
        case ReplayRefusal::manual_rows:
            return "In a part of the record no controller moved u. Send only the part in automatic (from, to).";
        case ReplayRefusal::feedback:
            return "Only the feedback moved u, so the model may describe the controller and not the plant. Send a "
                   "record with moves of the set point in column r.";
        case ReplayRefusal::no_set_point:
            return "The record has no set point, so its control error is unknown. Send column r as well.";
        case ReplayRefusal::doubtful_model:
            return "A warning about the model says that it may not describe this plant. Send a record with two or "
                   "three moves of the set point.";
        case ReplayRefusal::unknown_region:
            return "The model has no standard errors, so the error of a replay is unknown.";
        case ReplayRefusal::no_error:
            return "The recorded error is hardly more than the noise of y, which no settings change. Send a record in "
                   "which the set point or a disturbance moves y.";
        case ReplayRefusal::coarse_rows:
            return "The rows are too far apart for this plant: a controller would have to act between them. Record "
                   "faster.";
        case ReplayRefusal::no_law: return "The nonlinear integral of this controller is not supported here.";
        case ReplayRefusal::unstable: return "The loop is unstable on the model or on a plant that fits the record.";
        case ReplayRefusal::wide_band:
            return "The plants that fit the record differ too much to say what these settings would have done. A "
                   "record with more or larger moves of the set point narrows that.";
    }
    return "";
}

}  // namespace tunewright
