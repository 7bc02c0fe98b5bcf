// Recorded tests of the contract: arrays or CSV text.
#pragma once

#include "api/csv/csv_record.h"
#include "api/describe/description.h"
#include "engine/identification/identify.h"
#include "engine/request/verdict/finding.h"

namespace tunewright::api {

constexpr std::size_t kMaxSamples = 2'000'000;
constexpr std::size_t kMaxCsvLength = std::size_t{256} << 20;  ///< bytes; the limit on a request's body comes first

struct Units {
    std::optional<std::string> time, u, y;

    std::string time_or_default() const { return time.value_or("s"); }
};

/// The labels for sentences of an answer.
inline verdict::Labels labels_of(const std::optional<Units>& units) {
    if (!units) return {};
    return {units->time_or_default(), units->u.value_or(""), units->y.value_or("")};
}

/// A record as sent.
struct GivenRecord {
    std::optional<std::vector<double>> t, u, y, r;
    std::optional<std::vector<std::string>> mode;
    std::optional<std::vector<FurtherInput>> d;
    std::optional<double> dt;
    std::optional<std::string> csv;
    std::optional<ColumnChoices> columns;
    std::optional<std::string> time_unit;  ///< of the csv's times
    RecordKind kind = RecordKind::automatic;
    std::optional<double> u0, y0;
    std::optional<std::array<double, 2>> u_limits;
    std::optional<std::array<double, 2>> u_step;  ///< instead of u
    std::optional<int> run;                       ///< of a csv with several runs, from 1
    std::optional<double> from, to;               ///< the part that is used
};

/// Options of the identification and of its answer.
struct IdentifyQuestion : IdentifyOptions {
    bool traces = false;  ///< the record and the free runs of the models, for a plot
};

/// A record as the engine takes it, and the findings of reading it.
struct ReadRecord {
    Record record;
    int dropped = 0;
    std::vector<std::string> notes;
    std::string unread = {}, unread_column = {}, unknown_mode = {};  ///< as in CsvRecord
    bool time_unit_known = true;  ///< false: neither the file nor the request states the unit of the times
};

const Description<ColumnChoices>& columns_contract();
Codec<std::array<double, 2>> u_step();  ///< [from, to], two values
Codec<int> run_number();                ///< from 1
Codec<std::string> file_time_unit();    ///< A unit from which times can be converted.
const Description<Units>& units_contract();
const Description<GivenRecord>& record_contract();
const Description<IdentifyQuestion>& identify_contract();

/// Converts the record as sent; faults go to the reader, which is at the record.
ReadRecord resolve(GivenRecord given, const Units& units, Reader& reader);

/// Keeps the samples from `from` to `to`; all of them if neither is given. u and the disturbances keep their values
/// from the rows before. Reports if fewer than 2 samples are left, and if `from` leaves out the row to which u_step or
/// u0 refers.
void choose_part(const GivenRecord& given, ReadRecord& read, Reader& reader);

/// Reports each measured disturbance that moves only as u, y or another one does, at d or at columns/d.
void check_disturbances(const Record& record, bool from_csv, Reader& reader);

/// The warning unknown-mode, if there are unknown modes.
std::optional<Warning> mode_warning(const ReadRecord& read);

/// The faults of the record as it was read, a sentence each; its notes say how it was read.
std::vector<std::string> reading_faults(const ReadRecord& read);

/// Adds the findings of reading the record to the model.
void add_reading(const ReadRecord& read, IdentifiedModel& model);

/// Removes the traces unless the request asks for them.
void leave_out_traces(const IdentifyQuestion& question, IdentifiedModel& model);

}  // namespace tunewright::api
