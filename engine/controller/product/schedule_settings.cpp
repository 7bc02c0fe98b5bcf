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

bool same(const Note& a, const Note& b) { return a.code == b.code && a.detail == b.detail; }

bool holds(const std::vector<Note>& notes, const Note& note) {
    return std::any_of(notes.begin(), notes.end(), [&](const Note& other) { return same(other, note); });
}

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
    return answer;
}

}  // namespace tunewright::product
