// The forms in which made records are sent: the rows in addition to the test, and the files of loggers, read back by
// the product's own reader.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tests/records/judgement.h"

namespace tunewright::records {

/// Rows before the test, of the same plant, every `dt`: at rest before a countdown, else u at other levels, and then a
/// pause that was not logged. `settling`: rows until the plant rests; `size`: effect of a unit of u.
Record earlier_run(const MadeRecord& made, ActuatedPlant& process, double dt, int settling, double size,
                   Random& random);

/// A measured input that also moves y, with one to six moves or many. Adds its effect to `on_y`, row by row.
FurtherInput second_input(const MadeRecord& made, double dt, double size, std::vector<double>& on_y, Random& random);

/// CSV text: several runs in turn, times that count down, damaged cells, or a plain table.
///
/// 1. Several runs: the earlier run comes before the test, whose times start again, with or without its headings; a
///    third one in which nothing moves may follow. Or one run whose clock is set back by 1 to 8 rows, once; or a few
///    adjacent rows that are written in reverse order.
/// 2. Countdown: the rest in front of the test counts down to 0, or the whole test counts down to its end.
/// 3. Damaged cells, in 0.2 to 1.5 % of the lines: a word, a number with a word, a cut number, two lines in one, half a
///    line, a second decimal point.
std::string written(const MadeRecord& made);

/// The record, or the reader's first sentence.
std::variant<Record, std::string> read_back(const MadeRecord& made, const std::string& csv);

/// Evaluates the record as sent by the user: the columns, or the file.
Judgement judge_as_sent(MadeRecord made);

}  // namespace tunewright::records
