// The quality that a historian gives to a value, in words or codes.
#pragma once

#include <string_view>

namespace tunewright::api {

/// Reads cells of quality in the order of a file. Words: good, bad, uncertain, questionable and their like. Codes:
/// those of OPC DA (192 and more good, 64 to 127 uncertain, below 64 bad) and of OPC UA (0 good, from 0x40000000 on
/// uncertain or bad). 0 is bad only if a file also has codes of OPC DA; a file with 0 and 1 alone does not say which is
/// good.
class ValueQuality {
public:
    /// Learns the kind of codes from a cell.
    void look_at(std::string_view cell);
    /// True for bad and uncertain; false for good and for cells that say nothing.
    bool is_bad(std::string_view cell);

private:
    bool opc_da_ = false;
};

/// True for a word of bad or uncertain quality, in any letter case, also with details behind it: "Bad [Comm Failure]".
bool is_bad_quality(std::string_view word);

}  // namespace tunewright::api
