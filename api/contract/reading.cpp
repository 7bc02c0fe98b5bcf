#include "api/contract/record.h"

#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::api {
namespace {

/// Seconds that nothing names, and a plant that takes more than a day, as of milliseconds, or less than a thousandth of
/// a second, as of days.
void ask_for_unit(IdentifiedModel& model) {
    constexpr double kDay = 86400, kShort = 1e-3;
    const auto plant = LinearPlant::make(model.plant);
    if (!plant) return;
    const double total = plant->time_scale();
    const bool slow = total > kDay;
    if (!slow && !(total > 0 && total < kShort)) return;
    model.warnings.insert(
        model.warnings.begin(),
        {"time-unit-doubtful",
         (slow ? "The plant comes out slower than a day: its lags and dead time add up to " +
                     tunewright::text(total / kDay, 3) + " days"
               : "The plant comes out quicker than a millisecond: its lags and dead time add up to " +
                     tunewright::text(total, 3) + " s") +
             ", because the times were taken as seconds; nothing in the file names their unit. If they are " +
             (slow ? "milliseconds, choose ms" : "days, as spreadsheets count, choose d") +
             " as the unit of the times."});
}

}  // namespace

void add_reading(const ReadRecord& read, IdentifiedModel& model) {
    DataQuality& quality = model.data_quality;
    quality.time_unit_assumed = !read.time_unit_known;
    if (!read.time_unit_known) ask_for_unit(model);
    if (!read.unread.empty()) model.warnings.push_back({"lines-left-out", read.unread});
    if (!read.unread_column.empty()) model.warnings.push_back({"column-left-out", read.unread_column});
    quality.samples_dropped += read.dropped;
    quality.notes.insert(quality.notes.begin(), read.notes.begin(), read.notes.end());
    if (read.dropped > 0)
        quality.notes.push_back(std::to_string(read.dropped) +
                                " line(s) of the csv that cannot be read, or without a time, or with neither u nor y, "
                                "were left out.");
}

void leave_out_traces(const IdentifyQuestion& question, IdentifiedModel& model) {
    if (question.traces) return;
    model.fit = {};
    for (Candidate& candidate : model.candidates) candidate.y_model.clear();
}

}  // namespace tunewright::api
