// Files that do not have one line per sample, by shape, each converted to a table; empty if the file has another shape.
#pragma once

#include <optional>
#include <string_view>

#include "api/csv/column_choice.h"
#include "api/csv/shape/pivot.h"
#include "api/csv/table.h"

namespace tunewright::api {

/// The table of a text that is one JSON value: an array of objects (columns are the members, nested ones as "a.b"), an
/// array of arrays (rows; of arrays of objects, all of these one after the other), or an object that holds one such
/// array, or one array of numbers for each column. Line numbers of the table are those of the elements, from 1. Empty
/// if the text is not such a value.
std::optional<ShapedText> json_rows(std::string_view text);

/// "pwm: 1034.2 1.000" (name, time, value) in any place, and "1034.7 22.112" (time, value) for the rest: the format of
/// Klipper with WRITE_FILE=1. The unnamed values are "temp". Empty if lines of both kinds make up less than nine tenths
/// of the first 200, or have no common times.
std::optional<ShapedText> event_lines(std::string_view text);

/// ArduPilot's logs as text: "FMT, 128, 89, PIDR, QffffffffffBB, TimeUS,Tar,Act,..." defines the columns of the lines
/// that begin with "PIDR". The table has the columns of the kinds that `chosen` names ("RATE.ROut", or "ROut" where one
/// kind has it), at their own times; if nothing is chosen and only one kind has rows, its columns. Otherwise the fault
/// lists the kinds and their columns. Empty if no line defines columns.
std::optional<ShapedText> message_log(std::string_view text, const ColumnChoices& chosen);

/// The table with a column for each tag of a file that has a column of tags ("entity_id", "TagName", "_field"), one of
/// values and one of times, or one of dates and one of times of day: the format of Home Assistant, historians, InfluxDB
/// and Grafana. If several columns name parts of a tag, the parts that vary are joined by a point. Without headings: a
/// column of times, one of words that repeat, one of values. Empty for another file.
std::optional<ShapedText> long_table(std::string_view text, const CsvLayout& layout);

}  // namespace tunewright::api
