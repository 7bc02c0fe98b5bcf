// Whether the error oscillates, with which periods, and how regularly.
#pragma once

#include <span>
#include <vector>

#include "engine/check/loop_check.h"
#include "engine/check/samples.h"

namespace tunewright::check {

/// What further tests need beyond the periods themselves.
struct OscillationStudy {
    Oscillation found;
    std::vector<double> error;            ///< set point minus measurement
    std::vector<double> autocorrelation;  ///< of the error, from lag 0
    Curve spectrum;                       ///< share of the error's power over period, time
    Period strongest;                     ///< the first found one, else the strongest, which is not regular
};

OscillationStudy study_oscillation(const Samples& samples);

/// The oscillation with a period that is known from elsewhere; times of the record.
Period oscillation_of(const OscillationStudy& study, double period, double step);

}  // namespace tunewright::check
