// The user's result from a made record, compared with its plant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/request/tune.h"
#include "tests/records/made_record.h"

namespace tunewright::records {

struct Judgement {
    bool refused = false;
    std::string refusal;
    std::string model;                    ///< type of plant and the reason
    double K = 0, K_true = 0, K_std = 0;  ///< static gain, or slope if the plant integrates
    double K_std_told = 0;                ///< for the fit to a record that shows when u moved, if there is one
    bool comparable = true;               ///< found and true plant both integrate, or neither does
    bool gain_warned = false;             ///< a warning says that K, or the whole model, is unreliable
    bool warned_badly = false;            ///< a warning of level `bad`
    double response_error = 0;            ///< |G - G_true|/|G_true| at the loop's gain crossover
    double response_std = 0;              ///< according to the covariance
    std::optional<double> Ms_true;        ///< for the default design on the true plant; empty: unstable
    std::optional<double> IAE_ratio;      ///< load IAE of that loop over that of a design for the true plant itself
    double Ms_asked = 1.4;
    bool designed = false;
    std::vector<std::string> codes;  ///< of all warnings
    std::string detail;              ///< the choice and the warnings, as text

    double K_error() const;
    bool wrong_in_silence() const;  ///< K wrong by more than 10 % and 3 standard errors, without a warning that names
                                    ///< it
    std::optional<double> width() const;  ///< the interval's width relative to that of the record that shows when u
                                          ///< moved
    bool covered() const;                 ///< K_true within the stated 95 % interval
};

Judgement judge(const MadeRecord& made);

}  // namespace tunewright::records
