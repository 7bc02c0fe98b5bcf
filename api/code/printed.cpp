#include "api/code/printed.h"

#include "engine/number_text.h"

namespace tunewright::api {
namespace {

ControllerCode file_of(const code::Program& program, code::Language language, std::string text) {
    switch (language) {
        case code::Language::structured_text: return {"text/plain", code::type_name(program) + ".st", std::move(text)};
        case code::Language::c: return {"text/x-c", "tunewright_" + program.name + ".h", std::move(text)};
        case code::Language::python: return {"text/x-python", "tunewright_" + program.name + ".py", std::move(text)};
    }
    return {};
}

}  // namespace

ControllerCode printed(const code::Program& program, code::Language language, const code::Provenance& provenance,
                       const SampleTime& sample_time) {
    code::Provenance rows = provenance;
    rows.emplace_back("Sample time", tunewright::text(sample_time.seconds, 6) + " s, " + sample_time.origin);
    return file_of(program, language, code::print(program, language, rows));
}

}  // namespace tunewright::api
