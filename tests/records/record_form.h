// The forms in which made records are sent: what they have besides the test, and the files that loggers make of them,
// read back by the product's own reader.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "tests/records/judgement.h"

namespace tunewright::records {

/// Rows before the test, of the same plant, every `dt`: at rest in front of a countdown, else u at other levels, and
/// then a pause that nobody logged. `settling`: rows until the plant rests; `size`: what a unit of u moves.
Record earlier_run(const MadeRecord& made, ActuatedPlant& process, double dt, int settling, double size,
                   Random& random);

/// A measured input that moves y too, with one to six moves or many. Adds what it does to `on_y`, row by row.
FurtherInput second_input(const MadeRecord& made, double dt, double size, std::vector<double>& on_y, Random& random);

/// CSV text: several runs in turn, times that count down, damaged cells, or a plain table.
///
/// 1. Several runs: the earlier run stands in front of the test, whose times begin again, behind its headings or not; a
///    third one in which nothing moves may follow. Or one run whose clock is set back by 1 to 8 rows, once; or a few
///    neighbours that are written in turned order.
/// 2. Countdown: the rest in front of the test counts down to 0, or the whole test counts down to its end.
/// 3. Damaged cells, in 0.2 to 1.5 % of the lines: a word, a number with a word, a cut number, two lines in one, half a
///    line, a second decimal point.
std::string written(const MadeRecord& made);

/// The record, or the reader's first sentence.
std::variant<Record, std::string> read_back(const MadeRecord& made, const std::string& csv);

/// Judges the record as the user sends it: the columns, or the file.
Judgement judge_as_sent(MadeRecord made);

}  // namespace tunewright::records
