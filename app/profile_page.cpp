// The profile as one page: bars over time, a table, and what is known of each pass. It needs nothing else.

#include <cmath>

#include "app/profile.h"
#include "app/statistics.h"

namespace firn::app {

extern const char* const profile_script;  // profile_script.cpp

namespace {

constexpr const char* page_begin = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Profile</title><style>
:root { --ink: #1d2733; --pale: #5d6c7b; --line: #e2e7ed; --sheet: #f6f8fa; --chosen: #dcebfa; }
* { box-sizing: border-box; }
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; color: var(--ink); max-width: 1240px; margin: 0 auto; padding: 1.4em 1.2em 4em; }
h1 { font-size: 1.5em; margin: 0 0 .15em; } h2 { font-size: 1.1em; margin: 1.8em 0 .5em; }
p { margin: .3em 0; } .pale { color: var(--pale); }
.facts { display: flex; flex-wrap: wrap; gap: .6em; margin: 1em 0 0; }
.fact { background: var(--sheet); border: 1px solid var(--line); border-radius: 6px; padding: .45em .8em; }
.fact b { display: block; font-size: 1.15em; } .fact span { color: var(--pale); font-size: .86em; }
svg { display: block; width: 100%; background: var(--sheet); border: 1px solid var(--line); border-radius: 6px; }
svg text { font-size: 11px; fill: var(--pale); } svg .bar { cursor: pointer; } svg .dim { opacity: .22; }
table { border-collapse: collapse; width: 100%; font-size: .9em; }
th, td { text-align: left; padding: 4px 8px; border-bottom: 1px solid var(--line); }
th { cursor: pointer; user-select: none; white-space: nowrap; border-bottom-color: #b9c4cf; } th:hover { color: #1f5f99; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tbody tr { cursor: pointer; } tbody tr:hover, tr.hover { background: var(--sheet); } tbody tr.chosen { background: var(--chosen); }
.swatch { display: inline-block; width: 11px; height: 11px; border-radius: 2px; margin-right: 7px; vertical-align: -1px; }
.meter { display: inline-block; width: 60px; height: 7px; background: var(--line); border-radius: 3px; margin-left: 7px; overflow: hidden; }
.meter i { display: block; height: 100%; background: #4a7fb0; }
td:first-child { white-space: nowrap; }
.scroll { overflow-x: auto; }
#details { border: 1px solid var(--line); border-radius: 6px; padding: .9em 1.1em; margin-top: 1em; }
#details h3 { margin: 0 0 .3em; font-size: 1.05em; } #details table { margin-top: .7em; }
#tip { position: fixed; pointer-events: none; background: var(--ink); color: #fff; border-radius: 5px; padding: .35em .6em; font-size: .85em;
       display: none; max-width: 340px; z-index: 2; }
</style></head><body>
<h1 id="title"></h1><p class="pale" id="where"></p><div class="facts" id="facts"></div>
<h2>Steps, their passes on top of each other</h2><svg id="steps" height="190"></svg>
<p class="pale"><span id="shown"></span>Click a step to see it below; hover a bar for its pass.</p>
<h2 id="step-title"></h2><svg id="step"></svg>
<h2>Passes</h2><div class="scroll"><table id="passes"><thead><tr></tr></thead><tbody></tbody></table></div>
<p class="pale">Bytes: every element that a launch works on, read or written once. Of bound: the time that these bytes would take at the
device's rate of copying, or the formulas' additions and multiplications (maths) at its rate of arithmetic, whichever is longer, by the median;
beyond 100 % caches help, or the kernel does with fewer operations than the formulas; &le; where only the kernel knows which elements it touches. Click a column to sort, a pass for more.</p>
<div id="details"></div><div id="tip"></div>
<script type="application/json" id="data">)";

// Inside a script element only this could end it, or begin a comment.
std::string harmless(std::string text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) text.replace(at, 1, "\\u003c");
  return text;
}

constexpr std::size_t most_launches = 20000;  // a browser draws them in a moment

}  // namespace

std::string as_page(const Profile& profile) {
  nlohmann::json passes = nlohmann::json::array(), launches = nlohmann::json::array();
  for (const ProfiledPass& pass : profile.passes) {
    nlohmann::json traffic = nlohmann::json::array();
    for (const Traffic& one : pass.traffic)
      traffic.push_back({one.buffer, one.access, one.usage, one.read, one.written, one.at_most});
    const std::optional<Profile::Bound> bound = profile.bound(pass);
    const Holder holder = profile.held_back_by(pass);
    passes.push_back({{"stage", pass.stage},
                      {"work", pass.work},
                      {"doc", pass.doc},
                      {"equation", pass.equation},
                      {"elements", pass.elements},
                      {"host", pass.host},
                      {"launches", pass.seconds.size()},
                      {"median", median(pass.seconds)},
                      {"p90", quantile(pass.seconds, 0.9)},
                      {"total", pass.total()},
                      {"share", profile.share_of_time(pass)},
                      {"bytes", pass.bytes()},
                      {"rate", pass.bytes_per_second()},
                      {"maths", profile.share_of_arithmetic(pass).value_or(-1)},
                      {"bound", bound ? bound->share : -1},
                      {"by", bound && !bound->by_bytes ? "maths" : "bytes"},
                      {"at_most", bound && bound->at_most},
                      {"left_out", pass.left_out},
                      {"held", holder.name},
                      {"why", holder.sentence},
                      {"traffic", traffic}});
  }
  // Whole steps only.
  std::size_t shown = profile.launches.size();
  if (shown > most_launches)
    for (shown = most_launches; shown > 0 && profile.launches[shown].step == profile.launches[shown - 1].step;) --shown;
  const auto rounded = [](double seconds) { return std::round(seconds * 1e10) * 1e-10; };
  for (std::size_t i = 0; i < shown; ++i) {
    const ProfiledLaunch& launch = profile.launches[i];
    launches.push_back({launch.pass, launch.step, rounded(launch.start), rounded(launch.seconds)});
  }
  nlohmann::json data = {
      {"pipeline", profile.pipeline},
      {"scene", profile.scene},
      {"device", profile.device},
      {"clock", profile.clock},
      {"steps", profile.steps},
      {"wall", profile.wall},
      {"total", profile.total()},
      {"cost", nullptr},
      {"speed",
       {{"copy", profile.speed.bandwidth()}, {"multiply_add", profile.speed.multiply_add}, {"launch", profile.speed.launch}}},
      {"passes", passes},
      {"launches", launches}};
  if (profile.cost) data["cost"] = profile.cost->median;
  return page_begin + harmless(data.dump()) + "</script><script>" + profile_script + "</script></body></html>\n";
}

}  // namespace firn::app
