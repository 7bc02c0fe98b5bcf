// The calls that convert settings: from a controller or a schedule to the parameters of a product, and back.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/contract/product/product.h"
#include "api/contract/range/range_request.h"
#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/controller/pid.h"
#include "engine/controller/product/snippet.h"

namespace tunewright::api {

/// The members that both conversions take in addition to controller or settings.
struct BlockContext {
    std::optional<Units> units;
    std::optional<std::vector<double>> y_span, u_span;
    std::optional<double> sample_time;  ///< in units.time
    product::Context context;           ///< made of these; set in every request that was read without a fault
};

struct SettingsRequest : BlockContext {
    std::optional<Controller> controller;  ///< set in every request that was read without a fault
    bool nearest = false;
};
const Description<SettingsRequest>& settings_request_contract();

/// Texts to paste, [{"name", "text"}]: of settings, and of plants.
Codec<std::vector<product::FilledSnippet>> snippets();

/// The settings to type, also with an entry of a result.
struct SettingsAnswer {
    const product::Product* product = nullptr;
    product::Settings settings;  ///< in full precision
    product::Settings typed;     ///< as they are typed
    IdealPid realised;
    std::vector<product::Note> notes;
    product::Context context;
    std::map<std::string, double> standard_errors = {};  ///< by the name of the parameter; of settings from a record
};
const Description<SettingsAnswer>& settings_answer_contract();

/// The rows of a schedule that are to be typed.
struct ScheduleSettingsRequest : BlockContext {
    std::vector<GivenRow> rows;
    Interpolation interpolation = Interpolation::linear_in_gains;
    bool nearest = false;
};
const Description<ScheduleSettingsRequest>& schedule_settings_request_contract();

struct ScheduleSettingsAnswer {
    const product::Product* product = nullptr;
    product::ConvertedSchedule schedule;
};
const Description<ScheduleSettingsAnswer>& schedule_settings_answer_contract();

struct TwinRequest : BlockContext {
    product::Settings settings;  ///< as sent: the product checks names and values
};
const Description<TwinRequest>& twin_request_contract();

struct TwinAnswer {
    IdealPid controller;
    std::vector<product::Note> notes;
};
const Description<TwinAnswer>& twin_answer_contract();

}  // namespace tunewright::api
