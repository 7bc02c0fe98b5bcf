// Requests of the contract: a tuning job, an evaluation, an identification.
#pragma once

#include "api/contract/built/implement.h"
#include "api/contract/record.h"
#include "engine/request/tune.h"

namespace tunewright::api {

struct JobRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<PlantModel> plant;
    std::optional<Subject> subject;  ///< that `plant` describes
    std::optional<GivenRecord> record;
    IdentifyQuestion identify;
    std::vector<MethodRequest> tune = {MethodRequest{}};
    std::optional<Controller> baseline;
    std::optional<GivenBaseline> baseline_settings;  ///< in its place: as typed on a product
    std::optional<GivenBuild> implement;
    EvaluateOptions evaluate;
    std::string uncertainty = "auto";
    double timeout_s = 60;
    ReadRecord read;                             ///< of `record`
    std::optional<built::Build> build;           ///< of `implement`
    std::optional<built::Build> baseline_build;  ///< of `baseline_settings`
};

struct EvaluateRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<PlantModel> plant;
    std::optional<Subject> subject;  ///< that `plant` describes
    std::vector<Controller> controllers;
    std::optional<GivenBuild> implement;
    EvaluateOptions evaluate;
    std::optional<built::Build> build;  ///< of `implement`
};

struct IdentifyRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<GivenRecord> record;
    IdentifyQuestion identify;
    ReadRecord read;
};

/// Their checks include what the engine says about plant and controllers at once.
const Description<JobRequest>& job_contract();
const Description<EvaluateRequest>& evaluate_request_contract();
const Description<IdentifyRequest>& identify_request_contract();

const Description<EvaluateOptions>& evaluate_options_contract();

TuningRequest to_engine(JobRequest request);

}  // namespace tunewright::api
