#include "engine/controller/product/settings.h"

#include <algorithm>

namespace tunewright::product {
namespace {

void note_scheduling(const Product& product, const Schedule& schedule, std::vector<Note>& notes) {
    if (!product.scheduling) {
        notes.push_back(
            {"no-gain-scheduling",
             "No gain scheduling of this product is known here. A program beside it can write the settings as "
             "the rows say; see that a change does not make the output jump."});
        return;
    }
    const GainScheduling& own = *product.scheduling;
    if (own.sets > 0 && schedule.rows.size() > own.sets)
        notes.push_back({"too-many-rows", "The schedule has " + std::to_string(schedule.rows.size()) +
                                              " rows and the product holds " + std::to_string(own.sets) +
                                              " sets. Design it with \"rows\": " + std::to_string(own.sets) + "."});
    if (schedule.rows.size() < 2 || own.between == schedule.interpolation) return;
    std::string detail = "The schedule is meant with " + std::string(to_string(schedule.interpolation)) +
                         "; the product does otherwise between its rows: " + std::string(own.text);
    if (own.between)
        detail += " Design it with \"interpolation\": \"" + std::string(to_string(*own.between)) + "\".";
    else
        detail += " At the rows themselves it is exact.";
    notes.push_back({"interpolation", std::move(detail)});
}

bool is_switched(const Product& product, const std::string& name) {
    const Parameter* parameter = parameter_named(product, name);
    if (parameter == nullptr) return true;
    using enum Role;
    return parameter->role == gain || parameter->role == integral || parameter->role == derivative;
}

/// What comes with the known products for a schedule switches gain and times alone.
void note_held(const Product& product, ConvertedSchedule& answer) {
    if (!product.scheduling) return;
    std::vector<std::string> held;
    for (const RowSettings& row : answer.rows)
        for (const Setting& setting : row.converted.settings) {
            const bool differs = std::ranges::any_of(answer.rows, [&](const RowSettings& other) {
                return std::ranges::any_of(other.converted.settings, [&](const Setting& its) {
                    return its.name == setting.name && its.value != setting.value;
                });
            });
            if (differs && !is_switched(product, setting.name) && std::ranges::find(held, setting.name) == held.end())
                held.push_back(setting.name);
        }
    if (held.empty()) return;
    std::string names;
    for (const std::string& name : held) names += (names.empty() ? "" : ", ") + name;
    answer.notes.push_back({"held-between-rows",
                            "The rows differ in " + names + ", which the product's gain scheduling does not switch: " +
                                std::string(product.scheduling->text) +
                                " Give all rows the same filter and set-point weight, or write these values by a "
                                "program of your own."});
}

bool holds(const std::vector<Note>& notes, const Note& note) { return std::ranges::find(notes, note) != notes.end(); }

/// What every row says is said once.
void lift_common_notes(ConvertedSchedule& answer) {
    std::vector<RowSettings>& rows = answer.rows;
    std::vector<Note> common;
    for (const Note& note : rows.front().converted.notes)
        if (std::all_of(rows.begin(), rows.end(),
                        [&](const RowSettings& row) { return holds(row.converted.notes, note); }))
            common.push_back(note);
    for (RowSettings& row : rows)
        std::erase_if(row.converted.notes, [&](const Note& note) { return holds(common, note); });
    answer.notes.insert(answer.notes.end(), common.begin(), common.end());
}

}  // namespace

Expected<ConvertedSchedule> to_settings(const Product& product, const Schedule& schedule, const Context& context,
                                        bool nearest) {
    ConvertedSchedule answer;
    note_scheduling(product, schedule, answer.notes);
    for (const ScheduleRow& row : schedule.rows) {
        auto converted = to_settings(product, controller_of(row), context, nearest);
        if (!converted) {
            Error error = converted.error();
            if (error.kind == ErrorKind::not_representable) error.where = "rows/" + std::to_string(answer.rows.size());
            return error;
        }
        answer.rows.push_back({row.at, *std::move(converted)});
    }
    lift_common_notes(answer);
    note_held(product, answer);
    return answer;
}

}  // namespace tunewright::product
