#include "engine/number_text.h"

#include <fmt/format.h>

namespace tunewright {

std::string text(double x, int digits) { return fmt::format("{:.{}g}", x, digits); }

std::string exact_text(double x) { return fmt::format("{}", x); }

}  // namespace tunewright
