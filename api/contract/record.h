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

/// In which sentences of an answer speak.
inline verdict::Labels labels_of(const std::optional<Units>& units) {
    if (!units) return {};
    return {units->time_or_default(), units->u.value_or(""), units->y.value_or("")};
}

/// A record as sent.
struct GivenRecord {
    std::optional<std::vector<double>> t, u, y, r;
    std::optional<std::vector<FurtherInput>> d;
    std::optional<double> dt;
    std::optional<std::string> csv;
    std::optional<ColumnChoices> columns;
    std::optional<std::string> time_unit;  ///< of the csv's times
    RecordKind kind = RecordKind::automatic;
    std::optional<double> u0, y0;
    std::optional<std::array<double, 2>> u_limits;
    std::optional<std::array<double, 2>> u_step;  ///< in place of u
    std::optional<int> run;                       ///< of a csv with several, from 1
    std::optional<double> from, to;               ///< the part that counts
};

/// How a record becomes a model, and how much of that is answered.
struct IdentifyQuestion : IdentifyOptions {
    bool traces = false;  ///< the record and the free runs of the models, for a plot
};

/// A record as the engine takes it, and what reading it has found.
struct ReadRecord {
    Record record;
    int dropped = 0;
    std::vector<std::string> notes;
    std::string unread = {}, unread_column = {};  ///< as in CsvRecord
    bool time_unit_known = true;  ///< else the file does not say in which unit its times are, nor does the request
};

const Description<ColumnChoices>& columns_contract();
Codec<std::array<double, 2>> u_step();  ///< [from, to], two values
Codec<int> run_number();                ///< from 1
Codec<std::string> file_time_unit();    ///< one that times can be converted from
const Description<Units>& units_contract();
const Description<GivenRecord>& record_contract();
const Description<IdentifyQuestion>& identify_contract();

/// Reports to the reader, which stands at the record.
ReadRecord resolve(GivenRecord given, const Units& units, Reader& reader);

/// Keeps the samples from `from` to `to`; all of them where neither is given. u and the disturbances hold from the rows
/// before. Reports where fewer than 2 are left, and where `from` leaves out the row before which u_step or u0 is meant.
void choose_part(const GivenRecord& given, ReadRecord& read, Reader& reader);

/// Reports at d, or at columns/d, each measured disturbance that moves only as u, y or another one does.
void check_disturbances(const Record& record, bool from_csv, Reader& reader);

/// What reading the CSV has found belongs to the data's quality too.
void add_reading(const ReadRecord& read, IdentifiedModel& model);

/// Traces are answered only where they were asked for.
void leave_out_traces(const IdentifyQuestion& question, IdentifiedModel& model);

}  // namespace tunewright::api
