// Controllers as they are built: what there is, and the calls that convert their settings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/controller/pid.h"
#include "engine/controller/product/settings.h"

namespace tunewright::api {

/// An entry of GET /v1/controllers: enough to search by.
const Description<product::Product>& product_summary_contract();
/// GET /v1/controllers/{id}: everything.
const Description<product::Product>& product_contract();

/// What both conversions take beside controller or settings.
struct BlockContext {
    std::optional<Units> units;
    std::optional<std::vector<double>> y_span, u_span;
    std::optional<double> sample_time;  ///< in units.time
    product::Context context;           ///< of these, set in every request that was read without a fault
};

struct SettingsRequest : BlockContext {
    std::optional<Controller> controller;  ///< set in every request that was read without a fault
    bool nearest = false;
};
const Description<SettingsRequest>& settings_request_contract();

struct SettingsAnswer {
    const product::Product* product = nullptr;
    product::Converted converted;
};
const Description<SettingsAnswer>& settings_answer_contract();

struct TwinRequest : BlockContext {
    product::Settings settings;  ///< as sent: names and values are the product's to judge
};
const Description<TwinRequest>& twin_request_contract();

struct TwinAnswer {
    IdealPid controller;
    std::vector<product::Note> notes;
};
const Description<TwinAnswer>& twin_answer_contract();

}  // namespace tunewright::api
