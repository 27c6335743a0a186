#!/usr/bin/env bash
# Makes the environments and runs the whole training: local part, global head, export, evaluation.
# usage: training/run.sh [--data DIR] [--teacher FILE] [--local-steps N] [--smoke]
#   --smoke: a few steps of everything, to see that it runs.
# What was already trained in training/runs/ (or is in training/checkpoint/) is gone on with.
set -euo pipefail
cd "$(dirname "$0")/.."

shared=${DXSLAM_SHARED:-../shared}
data=$shared/data teacher=$shared/teachers/edgepoint2/edgepoint2_L64.onnx
steps=30000 decay=5000 semantic=8000 places=1500 photos=3600 out=models/hfnet runs=training/runs
while [ $# -gt 0 ]; do
  case $1 in
    --data) data=$2; shift 2 ;;
    --teacher) teacher=$2; shift 2 ;;
    --local-steps) steps=$2; shift 2 ;;
    --smoke) steps=50 decay=25 semantic=4 places=4 photos=500 out=out/smoke runs=out/smoke/runs; shift ;;
    *) sed -n '2,5p' "$0" >&2; exit 2 ;;
  esac
done

environment() {  # name, requirements file
  [ -x ".venvs/$1/bin/python" ] || python3 -m venv ".venvs/$1"
  ".venvs/$1/bin/python" -m pip install --quiet --requirement "$2"
}
environment train training/requirements-train.txt
environment deploy training/requirements-deploy.txt

# Waiting threads sleep instead of spinning: the workers share the cores.
export GOMP_SPINCOUNT=0 OMP_WAIT_POLICY=passive
train=.venvs/train/bin/python deploy=.venvs/deploy/bin/python
local_run=$runs/local global_run=$runs/global
mkdir -p "$local_run" "$global_run" "$out"
start=()
if [ ! -e "$local_run/last.pt" ] && [ "$out" = models/hfnet ] && [ -e training/checkpoint/hfnet.pt ]; then
  start=(--resume training/checkpoint/hfnet.pt)
fi
$train -m training.train --data "$data" --teacher "$teacher" --run "$local_run" \
  --steps "$steps" --decay-steps "$decay" "${start[@]}"
$train -m training.plot "$local_run/curves.csv" "$local_run/curves.svg"
$train -m training.train_global --data "$data" --local "$local_run/last.pt" --run "$global_run" \
  --photos "$photos" --semantic-steps "$semantic" --place-steps "$places"
$train -m training.export "$global_run/last.pt" "$runs/hfnet.onnx"
$deploy -m training.quantise "$runs/hfnet.onnx" --data "$data" --out "$out"
cp "$runs/hfnet.onnx" "$out/hfnet.onnx"
$deploy -m training.manifest "$out" --run "$(basename "$local_run")" --checkpoint-step "$steps"
$deploy -m training.evaluate "$out/hfnet.xml" "$out/hfnet_int8.xml" --data "$data" --out "$runs/evaluation.json"
