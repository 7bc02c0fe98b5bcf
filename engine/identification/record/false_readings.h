// Physically impossible readings of y: a sensor's error values, spikes, numbers that mean "no value".
#pragma once

#include <cstddef>
#include <vector>

#include "engine/identification/record/record_rows.h"

namespace tunewright {

/// Indices, ascending, of
/// - isolated values: the smallest or largest value, if the next one is five times the range of all the others
///   away, and it makes up less than half of the samples (-9999, 1e9, 0 of a sensor that reads 20 to 21); then the same
///   for the remaining samples, at most three times;
/// - values by which sensors report a fault (85 and -127 of a DS18B20, 850 and 1820 of thermocouple amplifiers, -999,
///   999, ...), once or several in a row, if y jumps there and back by a tenth of the range of the other samples and
///   ten times its usual move, and the samples on either side agree; at the end of the record, a jump there is enough.
///   They are at most a quarter of the samples. A y that passes through such a value keeps it;
/// - spikes of one or two samples that lie a quarter of the range away from the median of five, and ten times farther
///   than nine tenths of all samples do, while the samples on either side agree; none if they are more than 1 % (or
///   3) of all, and none in the last or first two samples. A process faster than the sampling responds to a pulse of
///   one sample in the same way, so a warning lists the removed samples.
std::vector<std::size_t> false_readings(const RecordRows& rows);

/// Removes first rows without a reading (drop_unread_rows, drop_silent_rows), decided without the false readings after
/// them, and then all false readings, which are recorded in `cleaning`. `u0_given`: rows before the first reading of u
/// are not removed.
void drop_false_readings(RecordRows& rows, bool u0_given, Cleaning& cleaning);

}  // namespace tunewright
