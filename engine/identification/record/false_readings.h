// Readings that no process makes: spikes, and numbers that stand for "no value".
#pragma once

#include <span>
#include <vector>

namespace tunewright {

/// Indices, ascending, of
/// - a number that stands apart: the least or greatest value, if the next one is five times the range of all the
///   others away, and it makes up less than half of the samples (-9999, 1e9, 0 of a sensor that reads 20 to 21);
/// - spikes of one or two samples that lie a quarter of the range away from the median of five, and ten times farther
///   than nine tenths of all samples do, while the samples on either side agree; none if they are more than 1 % (or
///   3) of all, and none in the last or first two samples. (A process faster than the sampling answers a pulse of one
///   sample like that: who pulses so must look at the warning.)
std::vector<std::size_t> false_readings(std::span<const double> y);

}  // namespace tunewright
