// Variables of the environment that look like settings of the service.
#include <algorithm>
#include <string_view>

#include "api/describe/suggest.h"
#include "server/cli/command_tree.h"

namespace tunewright::server {
namespace {

constexpr std::string_view kPrefix = "TUNEWRIGHT_";

bool is_of_kubernetes(std::string_view name, std::string_view value) {
    return name.find("_SERVICE_") != std::string_view::npos || name.find("_PORT_") != std::string_view::npos ||
           value.starts_with("tcp://");
}

}  // namespace

std::vector<std::string> strange_variables(const std::vector<std::string>& environment,
                                           const std::vector<std::string>& known) {
    std::vector<std::string> endings;
    for (const std::string& name : known) endings.push_back(name.substr(kPrefix.size()));
    std::vector<std::string> sentences;
    for (const std::string& variable : environment) {
        const std::string name = variable.substr(0, variable.find('='));
        const std::string_view value = std::string_view(variable).substr(std::min(name.size() + 1, variable.size()));
        if (!name.starts_with(kPrefix) || std::ranges::find(known, name) != known.end()) continue;
        if (is_of_kubernetes(name, value)) continue;
        const std::string meant = api::nearest(name.substr(kPrefix.size()), endings);
        std::string sentence = "the variable " + name + " is set, and there is no such setting.";
        sentence += meant.empty() ? " `tunewright serve --help` names all"
                                  : " Did you mean " + std::string(kPrefix) + meant + "?";
        sentences.push_back(std::move(sentence));
    }
    return sentences;
}

}  // namespace tunewright::server
