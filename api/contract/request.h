// Requests of the contract: a tuning job, an evaluation, an identification.
#pragma once

#include "api/contract/device/device.h"
#include "api/contract/device/given_controller.h"
#include "api/contract/plant/plant.h"
#include "api/contract/record.h"
#include "api/contract/terms.h"
#include "api/describe/description.h"
#include "engine/request/tune.h"

namespace tunewright::api {

/// The member `evaluate` of a request.
struct EvaluateQuestion : EvaluateOptions {
    std::optional<OwnStep> own_step;  ///< simulated with every controller
};

struct JobRequest : JobTerms {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<PlantModel> plant;
    std::optional<AnalysedPlant> subject;  ///< the analysed `plant`
    std::optional<GivenRecord> record;
    std::optional<UltimateTest> ultimate;
    std::optional<IdentifiedModel> model;  ///< of a record, sent back by the client; of a design only
    IdentifyQuestion identify;
    std::vector<MethodRequest> tune = {MethodRequest{}};
    std::vector<SentController> controllers;
    std::optional<SentController> baseline;
    bool baseline_from_record = false;  ///< instead of `baseline`: as the record shows it
    std::optional<GivenDevice> implement;
    EvaluateQuestion evaluate;
    verdict::GivenSteps given_steps;  ///< of `evaluate`
    std::string uncertainty = "auto";
    ReadRecord read;                            ///< of `record`
    std::optional<device::DeviceModel> device;  ///< of `implement`
};

/// A tuning request, answered while the client waits.
struct DesignRequest : JobRequest {
    std::optional<Controller> start;  ///< an initial design nearby; a hint
};

struct EvaluateRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<PlantModel> plant;
    std::optional<IdentifiedModel> model;  ///< instead of a plant: the model of a record, sent back by the client
    std::optional<AnalysedPlant> subject;  ///< the analysed plant
    std::vector<SentController> controllers;
    std::optional<GivenDevice> implement;
    EvaluateQuestion evaluate;
    verdict::GivenSteps given_steps;            ///< of `evaluate`
    std::optional<device::DeviceModel> device;  ///< of `implement`
};

struct IdentifyRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<GivenRecord> record;
    IdentifyQuestion identify;
    ReadRecord read;
};

/// Their checks include those of the engine for plant and controllers.
const Description<JobRequest>& job_contract();
const Description<DesignRequest>& design_request_contract();
const Description<EvaluateRequest>& evaluate_request_contract();
const Description<IdentifyRequest>& identify_request_contract();

const Description<EvaluateQuestion>& evaluate_options_contract();

/// The members that name the subject of a request; each request has one of them.
const std::vector<std::string>& request_sources();
/// True if a request of any kind has a member of that name.
bool is_request_member(std::string_view name);

/// The analysed plant; empty after a fault, which the reader then has.
std::optional<AnalysedPlant> subject_of(const PlantModel& plant, Reader& reader);

/// Points of a trace: 0 (none), or from 2 on.
Codec<int> trace_points();

/// The members that every request may carry.
template <class Request>
void add_labels(Description<Request>& d) {
    d.field("name", &Request::name, maybe(text(kMaxNameLength)), "A label, such as the loop's tag.")
        .field("units", &Request::units, maybe(object(units_contract())), "Labels of the units, echoed.");
}

/// The controllers of a request that was read without a fault.
std::vector<GivenController> given(const std::vector<SentController>& controllers);

TuningRequest to_engine(JobRequest request);

}  // namespace tunewright::api
