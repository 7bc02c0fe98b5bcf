// The time column of a file as numbers in the unit of the answer.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/csv/columns/columns.h"
#include "api/csv/running_clock.h"
#include "api/csv/time_stamp.h"

namespace tunewright::api {

/// Reads one cell after another, in the order of the file.
class TimeColumn {
public:
    /// Searches the file for facts that a single cell does not show: stamps or numbers, unit, day or month first. Adds
    /// its faults; notes state the assumptions.
    TimeColumn(std::string_view text, const CsvLayout& layout, const DetectedColumns& columns,
               const ColumnProfile& profile, const CsvOptions& options, std::vector<CsvFault>& faults);

    /// False if the cell is not a time. `clock` is the cell of the second column, if there is one.
    bool read(std::string_view cell, std::string_view clock, int line, double& time);

    /// The two halves of read() for a column of stamps: a caller with many equal cells need not parse each.
    std::optional<TimeStamp> stamp(std::string_view cell, std::string_view clock) const;
    double time_of(const TimeStamp& stamp, int line);

    bool stamps() const { return stamps_; }
    /// True if the file or the request states the unit of the times.
    bool unit_known() const { return stamps_ || unit_known_; }
    std::vector<std::string> take_notes();

    // After the first time has been read:

    /// The file's own time at which read() gives 0, in the unit of the answer.
    double zero() const { return first_ && (stamps_ || from_zero_) ? *first_ * factor_ : 0; }
    /// Seconds since 1970 at which read() gives 0; empty if the times have no date.
    std::optional<double> epoch() const;
    /// True if these seconds are in UTC: the stamps have a zone, or the times count since 1970.
    bool in_utc() const { return !stamps_ || zoned_; }

private:
    void note_unknown_unit(const ColumnProfile& profile, const CsvOptions& options);
    void read_short_clock(std::string_view text, const CsvLayout& layout, std::size_t column);
    void find_order(std::string_view text, const CsvLayout& layout, const DetectedColumns& columns);
    void find_unit(std::string_view text, const CsvLayout& layout, const DetectedColumns& columns,
                   const ColumnProfile& profile, const CsvOptions& options);
    std::optional<std::string> unit_by_size(std::string_view text, const CsvLayout& layout, std::size_t column) const;
    std::optional<std::string> unit_by_clock(std::string_view text, const CsvLayout& layout, std::size_t column) const;
    bool stamps_ = false;
    DateOrder order_ = DateOrder::day_first;
    DecimalSign sign_;
    std::string suffix_;
    double factor_ = 1;
    bool from_zero_ = false, unit_known_ = false;
    bool counts_days_ = false;            // as spreadsheets do
    bool short_is_minutes_ = false;       // "75:20" is minutes and seconds
    bool dated_ = false, zoned_ = false;  // the first stamp
    double answer_s_ = 0;                 // seconds of the unit of the answer; 0: it is not a known unit
    RunningClock clock_;
    std::optional<double> first_;
    std::vector<std::string> notes_;
};

}  // namespace tunewright::api
