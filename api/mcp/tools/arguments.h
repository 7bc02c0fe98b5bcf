// Arguments that are not those of a call of the service.
#pragma once

#include <optional>
#include <string>

#include "api/contract/controller.h"
#include "api/contract/record.h"
#include "api/describe/description.h"

namespace tunewright::api::mcp {

struct JobQuestion {
    std::optional<std::string> job;
};
const Description<JobQuestion>& job_question_contract();

struct ProductQuestion {
    std::optional<std::string> product, search;
};
const Description<ProductQuestion>& product_question_contract();

struct MethodQuestion {
    std::optional<std::string> method;
};
const Description<MethodQuestion>& method_question_contract();

struct SettingsQuestion {
    std::string product;
};
const Description<SettingsQuestion>& settings_question_contract();

/// The subject of a program: a controller of a job, or one that is given. The other arguments are parameters of the
/// program.
struct ProgramSubject {
    std::optional<std::string> job;
    std::optional<int> index;
    std::optional<Controller> controller;
    std::optional<Units> units;
};
const Description<ProgramSubject>& program_subject_contract();

}  // namespace tunewright::api::mcp
