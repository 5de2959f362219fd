#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace firn::app {

// Whether the outputs of a run that was repeated are the same; says so on stdout, with what differs, and on stderr what was
// different from the start.
bool tell_of_repeat(const nlohmann::json& manifest, const nlohmann::json& identity, const std::string& device,
                    const nlohmann::json& outputs);

}  // namespace firn::app
