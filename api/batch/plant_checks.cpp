#include "api/batch/plant_checks.h"

#include <algorithm>

#include "api/contract/check/check_result.h"
#include "api/contract/check/loop_check.h"
#include "api/csv/cell.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/check/together/plant_check.h"

namespace tunewright::api {
namespace {

constexpr const char* kCancelled = "It was cancelled before it was checked.";
/// The parts of a loop's answer that are drawn of a single loop, and those that are written anew.
constexpr const char* kLeftOut[] = {"excerpt", "spectrum", "autocorrelation", "shape", "cause", "action"};

std::string lower_tag(const check::LoopCheck& loop) { return lower_case(loop.tag); }

/// By tag, whatever the case of its letters.
void compare(const std::deque<check::LoopCheck>& now, const std::deque<check::LoopCheck>& before, BatchCheck& out) {
    for (std::size_t i = 0; i < now.size(); ++i) {
        const auto same = std::ranges::find(before, lower_case(now[i].tag), lower_tag);
        if (same == before.end()) {
            out.only_now.push_back(now[i].tag);
            continue;
        }
        out.compared.push_back({i, now[i].tag});
        out.changes.push_back(check::change_of(*same, now[i]));
    }
    for (const check::LoopCheck& one : before)
        if (std::ranges::find(now, lower_tag(one), lower_tag) == now.end()) out.only_before.push_back(one.tag);
}

/// Changes the causes that another loop explains.
check::PlantCheck judged_together(std::deque<check::LoopCheck>& loops) {
    std::vector<check::LoopCheck*> all;
    for (check::LoopCheck& one : loops) all.push_back(&one);
    return check::check_plant(all);
}

}  // namespace

void PlantChecks::add(const CheckEntry& entry) {
    const Json parsed = Json::parse(entry.result, nullptr, false);
    if (!parsed.is_object() || !parsed.contains("loops")) {
        const Json error = Json::parse(entry.error, nullptr, false);
        failed_.push_back({std::string(entry.name), error.is_object() ? error.value("detail", "") : kCancelled});
        return;
    }
    std::size_t place = 0;
    for (const Json& loop : parsed["loops"]) {
        checks_.push_back(read_loop_check(loop));
        sources_.push_back({entry.index, place++});
        Json kept = loop;
        for (const char* name : kLeftOut) kept.erase(name);
        if (kept_ == Kept::none) kept.erase("trend");
        kept["index"] = entry.index;
        kept["job"] = std::string(entry.id);
        if (parsed.contains("units")) kept["units"] = parsed["units"];
        std::string text = kept.dump();
        text.pop_back();
        texts_.push_back(std::move(text));
    }
}

std::string PlantChecks::answer(bool complete, const PlantChecks* before) const {
    BatchCheck out;
    std::deque<check::LoopCheck> judged = checks_;
    out.plant = judged_together(judged);
    for (std::size_t i = 0; i < judged.size(); ++i) {
        Writer members;
        members.begin_object();
        write_cause_and_action(judged[i], members);
        members.end_object();
        out.loops.push_back(texts_[i] + "," + members.take().substr(1));
    }
    if (before != nullptr) {
        std::deque<check::LoopCheck> earlier = before->checks_;
        judged_together(earlier);
        compare(judged, earlier, out);
    }
    // An entry that was cancelled has neither result nor error.
    out.complete = complete && std::ranges::find(failed_, kCancelled, &Failed::reason) == failed_.end();
    out.failed = static_cast<int>(failed_.size());
    Writer text;
    batch_check_contract().write(out, text);
    return text.take();
}

}  // namespace tunewright::api
