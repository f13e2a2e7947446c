// SPDX-License-Identifier: Apache-2.0
#include "vantage/report/html.h"

namespace vantage {

std::string style_sheet() {
  return R"css(
:root { --paper: #fbfaf8; --card: #ffffff; --plate: #f3f1ec; --ink: #1d2430; --soft: #5a6474; --faint: #e4e1da; --grid: #e9e6df;
  --c1: #2458c5; --c2: #b4540a; --c3: #0f766e; --c4: #8a2fb0; --c5: #a07800; --c6: #7a4a2b; --c7: #5d6b1a; --c8: #0881a8;
  --good: #0f766e; --open: #b4540a; --mark: #d81b4a; --halo: #ffffff; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #12151b; --card: #191d25; --plate: #0c0e13; --ink: #e9ecf2; --soft: #a3adbd; --faint: #2b313c; --grid: #262c36;
    --c1: #82aaff; --c2: #f0a35e; --c3: #5eccbc; --c4: #cf9cf0; --c5: #e3c65b; --c6: #cfa585; --c7: #b9cb6a; --c8: #6ecbe8;
    --good: #5eccbc; --open: #f0a35e; --mark: #ff4d78; --halo: #0c0e13; }
}
@media (prefers-color-scheme: dark) {
  #surface img, #unseen img, #path img, #known img, #next img, #next-space img { filter: brightness(.8); }
  #points img { filter: brightness(1.3); }
  #path .stage, #next .stage { background: #6f6e6b; }
  #path .stage, #next .stage, #next-space .stage, #surface .stage { --mark: #d81b4a; --halo: #ffffff; --ink: #1d2430; }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 17px/1.6 ui-sans-serif, system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif;
  font-variant-numeric: tabular-nums; }
main, header, footer { max-width: 1160px; margin: 0 auto; padding: 0 28px; }
header { padding-top: 72px; }
.eyebrow { margin: 0; color: var(--soft); font-size: 13px; font-weight: 600; letter-spacing: .12em; text-transform: uppercase; }
h1 { margin: 4px 0 28px; font-size: clamp(38px, 7vw, 68px); line-height: 1.05; letter-spacing: -.025em; font-weight: 750; overflow-wrap: anywhere; }
h2 { margin: 0 0 18px; font-size: 26px; line-height: 1.25; letter-spacing: -.012em; font-weight: 680; }
h3 { margin: 0 0 8px; font-size: 16px; font-weight: 640; }
h3 small { color: var(--soft); font-weight: 400; font-size: 14px; }
.verdict { display: grid; grid-template-columns: 1fr auto; gap: 24px 56px; align-items: end; margin: 0 0 12px; }
.verdict p { margin: 0; max-width: 44em; font-size: 20px; line-height: 1.5; }
.verdict b { color: var(--v); }
.done { --v: var(--good); } .not-done { --v: var(--open); }
.share { min-width: 200px; }
.share strong { display: block; font-size: 52px; line-height: 1; letter-spacing: -.03em; font-weight: 700; color: var(--v); white-space: nowrap; }
.share span { color: var(--soft); font-size: 14px; }
.gauge { position: relative; height: 6px; margin: 28px 0 0; border-radius: 4px; background: var(--faint); overflow: hidden; }
.gauge i { position: absolute; top: 0; bottom: 0; left: 0; background: var(--v); }
.gauge i.bounds { opacity: .4; }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(180px, 1fr)); gap: 28px 32px; margin: 44px 0 0; padding: 26px 0;
  border-block: 1px solid var(--faint); }
dt { color: var(--soft); font-size: 14px; }
dd { margin: 2px 0 0; font-size: 25px; font-weight: 640; line-height: 1.25; letter-spacing: -.01em; }
dd small { display: block; color: var(--soft); font-size: 14px; font-weight: 400; letter-spacing: 0; line-height: 1.4; }
figure { margin: 0; }
.plate, section { margin-top: 88px; }
.stage { position: relative; overflow: hidden; border-radius: 12px; background: var(--plate); }
.stage img { display: block; width: 100%; height: auto; }
.stage svg { position: absolute; inset: 0; width: 100%; height: 100%; }
.panels { display: grid; gap: 28px 20px; }
.many .panels { grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); }
.many .stage { border-radius: 8px; outline: 1px solid var(--faint); }
.panel p { margin: 8px 0 0; color: var(--soft); font-size: 14px; line-height: 1.45; }
figcaption { margin-top: 14px; color: var(--soft); font-size: 15px; max-width: 62em; }
.legend { display: flex; flex-wrap: wrap; gap: 6px 24px; margin-top: 10px; color: var(--ink); font-size: 14px; }
.key { display: inline-flex; align-items: center; gap: 8px; }
.key i { flex: none; display: inline-block; width: 14px; height: 14px; background: var(--c); }
.key .bar { width: 120px; height: 10px; border-radius: 5px; }
.key .area { border-radius: 4px; border: 1px solid color-mix(in srgb, var(--soft) 45%, transparent); }
.key .hatch { border-radius: 4px; border: 1px solid color-mix(in srgb, var(--soft) 45%, transparent);
  background-image: repeating-linear-gradient(135deg, rgb(128 140 170 / .55) 0 2px, transparent 2px 5px); }
.key .dot { --d: var(--c, var(--mark)); width: 11px; height: 11px; border-radius: 50%; background: var(--d); }
.key .line { width: 22px; height: 3px; border-radius: 2px; background: var(--c, var(--mark)); }
.key .diamond { width: 10px; height: 10px; background: #35d0c0; transform: rotate(45deg); border: 1px solid #0b1f28; }
.key .cross { width: 15px; height: 15px; background: linear-gradient(#e5326a, #e5326a) center / 15px 3px no-repeat, linear-gradient(#e5326a,
  #e5326a) center / 3px 15px no-repeat; transform: rotate(45deg); }
.key .rank { width: 16px; height: 16px; border-radius: 4px; background: #3f37b5; border: 1px solid #fff; }
.key .dashes { width: 24px; height: 3px; background: repeating-linear-gradient(90deg, #3f37b5 0 7px, transparent 7px 12px); }
.key .zone { border-radius: 4px; border: 2px dashed var(--z); background: color-mix(in srgb, var(--z) 22%, transparent); }
.zone { fill: var(--z); fill-opacity: .2; fill-rule: evenodd; stroke: var(--z); stroke-width: 2; stroke-dasharray: 7 4; }
.zone.out { --z: #c62828; } .zone.see { --z: #00897b; } .zone.sides { fill: none; stroke-width: 1.3; }
.unseen { fill: #2c2680; font-size: 14px; font-weight: 600; text-anchor: middle; paint-order: stroke; stroke: #ffffff; stroke-width: 4px;
  stroke-linejoin: round; }
.way { fill: none; stroke: var(--mark); stroke-width: 2.4; stroke-linejoin: round; stroke-linecap: round; opacity: .9; }
.way.tour { stroke: #3f37b5; stroke-dasharray: 9 6; stroke-width: 2.6; }
.way.casing { stroke: var(--halo); stroke-width: 5; opacity: .65; }
.dot { fill: var(--mark); stroke: #fff; stroke-width: 1.5; }
.pin circle { fill: var(--mark); stroke: #fff; stroke-width: 2; }
.pin.first circle { fill: #1d2430; }
.pin text, .tag text { fill: #fff; font-size: 12.5px; font-weight: 700; text-anchor: middle; }
.tag path { stroke: var(--ink); stroke-width: 1.5; } .tag circle { fill: var(--ink); }
.tag rect { fill: #3f37b5; stroke: #fff; stroke-width: 1.5; } .tag text { font-size: 15px; }
.diamond { fill: #35d0c0; stroke: #0b1f28; stroke-width: 1.2; }
.cross { fill: none; stroke: #ff3d78; stroke-width: 5; stroke-linecap: round; }
.cross.casing { stroke: #fff; stroke-width: 9; }
.scale path { fill: none; stroke: var(--ink); stroke-width: 2; } .scale .casing { stroke: var(--halo); stroke-width: 5; opacity: .7; }
.scale text { fill: var(--ink); font-size: 18px; text-anchor: middle; paint-order: stroke; stroke: var(--halo); stroke-width: 4px;
  stroke-linejoin: round; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 420px), 1fr)); gap: 48px 40px; }
.chart svg { display: block; width: 100%; height: auto; overflow: visible; }
.chart figcaption { margin-top: 4px; font-size: 14px; }
.grid { stroke: var(--grid); } .axis { stroke: var(--soft); fill: none; } .band { fill: var(--c1); opacity: .16; }
.tick, .label { fill: var(--soft); font-size: 13px; }
.name { fill: var(--c); font-size: 14px; font-weight: 600; }
.curve path { fill: none; stroke: var(--c); stroke-width: 2.2; stroke-linejoin: round; }
.curve.dashed path { stroke-dasharray: 7 5; stroke-width: 1.8; } .curve.dashed circle { r: 1.6px; }
.curve.dense circle { stroke: none; r: 1.2px; }
.bars text { fill: var(--ink); font-size: 14px; } .bars .soft { fill: var(--soft); } .bars rect { fill: var(--c); }
.bars path { stroke: var(--ink); stroke-width: 1.6; stroke-dasharray: 4 3; }
.curve .under { fill: var(--c); stroke: none; opacity: .12; }
.curve circle { fill: var(--c); stroke: var(--paper); stroke-width: 1; }
.scroll { overflow-x: auto; }
table { width: 100%; border-collapse: collapse; font-size: 15px; line-height: 1.45; }
th { color: var(--soft); font-size: 13px; font-weight: 600; text-align: left; vertical-align: bottom; white-space: nowrap; }
th, td { padding: 9px 20px 9px 0; border-bottom: 1px solid var(--faint); } td { vertical-align: top; }
.n { text-align: right; white-space: nowrap; }
details { border-bottom: 1px solid var(--faint); } details:first-of-type { border-top: 1px solid var(--faint); }
summary { padding: 16px 0; font-weight: 640; cursor: pointer; } details > :last-child { margin-bottom: 28px; }
pre { margin: 0; padding: 16px 20px; border-radius: 10px; background: var(--plate); overflow-x: auto;
  font: 15px/1.5 ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; user-select: all; }
.note { color: var(--soft); max-width: 62em; }
footer { margin-top: 96px; padding-bottom: 56px; color: var(--soft); font-size: 14px; }
@media (max-width: 700px) {
  body { font-size: 16px; } main, header, footer { padding: 0 18px; } header { padding-top: 36px; }
  .verdict { grid-template-columns: 1fr; } .verdict p { font-size: 18px; }
  dl { grid-template-columns: 1fr 1fr; gap: 22px 16px; } dd { font-size: 20px; }
  .plate, section { margin-top: 60px; } h2 { font-size: 22px; } .many .panels { grid-template-columns: 1fr 1fr; gap: 20px 12px; }
    .panel p { font-size: 13px; }
  .plate:not(.many) .stage { border-radius: 8px; }
  .plate:not(.many) .dot { r: 10px; } .plate:not(.many) .pin { display: none; } .plate:not(.many) .pin.major { display: inline; }
  .plate:not(.many) .way { stroke-width: 5; } .plate:not(.many) .way.casing { stroke-width: 9; }
  .pin circle { r: 26px; } .pin text { font-size: 30px; } .tag { transform-box: fill-box; transform-origin: 50% 100%; transform: scale(2.1); }
  .tag.below { transform-origin: 50% 0; }
    .scale text { font-size: 36px; }
  .chart { margin-right: -6px; } .tick, .label { font-size: 15px; } .name { font-size: 16px; }
}
@media print {
  :root { --paper: #fff; --card: #fff; --plate: #fff; --ink: #000; --soft: #444; --faint: #ccc; --grid: #ddd; --halo: #fff;
    --c1: #2458c5; --c2: #b4540a; --c3: #0f766e; --good: #0f766e; --open: #b4540a; --mark: #d81b4a; }
  body { font-size: 11pt; } header { padding-top: 0; } figure, tr { break-inside: avoid; } h2 { break-after: avoid; }
    .plate, section { margin-top: 32px; }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";
}

}  // namespace vantage
