// A schedule as it is typed into a product: the settings of each row, and how the product goes from one to the next.
#pragma once

#include <vector>

#include "engine/controller/product/settings.h"

namespace tunewright::product {

struct RowSettings {
    double at = 0;
    Converted converted = {};  ///< notes: of this row alone
};

struct ConvertedSchedule {
    std::vector<RowSettings> rows = {};
    std::vector<Note> notes = {};  ///< of the schedule, then those that every row would have
};

/// Each row as `to_settings` converts it. Notes of the schedule: `no-gain-scheduling` where none of the product is
/// known, `too-many-rows` where it holds fewer sets, `interpolation` where it goes otherwise from one to the next.
/// Errors: those of a row, at "rows/K" where it is the row that the product cannot be.
Expected<ConvertedSchedule> to_settings(const Product& product, const Schedule& schedule, const Context& context,
                                        bool nearest);

}  // namespace tunewright::product
