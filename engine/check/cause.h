// Why a loop is as it is.
#pragma once

#include <stop_token>

#include "engine/check/loop_check.h"
#include "engine/check/oscillation/oscillation.h"
#include "engine/check/output_range.h"
#include "engine/check/samples.h"
#include "engine/check/service.h"

namespace tunewright::check {

/// What the cause is concluded from. The record is good enough.
struct CauseQuestion {
    const LoopQuestion& loop;
    const Samples& samples;
    const OscillationStudy& oscillation;
    const OutputRange& u_range;
    const RecordQuality& quality;
    const ServiceShares& service;
    const LoopLaw& law;
    const UnitNames& units;
};

Cause cause_of(const CauseQuestion& question, const std::stop_token& stop);

/// The cause if the record is not good enough: its first fatal remark.
Cause insufficient(const RecordQuality& quality);

}  // namespace tunewright::check
