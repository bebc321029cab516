# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash disable=SC2154
# Several ranks make the mesh that one process makes. $program is eigencrust-mpi, the ordinary command lies beside it.

# More ranks than cores are wanted here, and tests may run as root.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
# Containers may forbid what these are for.
export OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl_vader_single_copy_mechanism=none

# Where processes may not be started so, or not speak to each other, nothing can be said of ours.
timeout 60 mpiexec -n 2 true >/dev/null 2>why || skip "mpiexec does not run here: $(grep . why | head -3 | tr '\n' ' ')"
rm -f why

ordinary=$(dirname -- "$program")/eigencrust

# ranks N ARGUMENTS: as run, on N ranks.
ranks() {
  local count=$1
  shift
  status=0
  timeout 250 mpiexec -n "$count" "$program" "$@" >out 2>err </dev/null || status=$?
}

# expect_same_mesh CLOUD: on 1, 2, 3, 4 and 8 ranks.
expect_same_mesh() {
  "$ordinary" "$1" -o one.ply -q || die "the ordinary command failed"
  local count
  for count in 1 2 3 4 8; do
    ranks "$count" "$1" -o ranks.ply
    equal "status of $count ranks" "$status" 0
    same one.ply ranks.ply
    [ "$(grep -c ' points in ' out)" -eq 1 ] || die "not one summary from $count ranks"
  done
}

test_ranks_make_the_same_mesh() { expect_same_mesh "$repository/examples/teapot_scan.ply"; }

test_ranks_make_the_same_mesh_of_an_exact_grid() {
  awk 'BEGIN { for (i = 0; i < 60; ++i) for (j = 0; j < 60; ++j) for (k = 0; k < 60; ++k)
    if (i < 3 || j < 3 || k < 3 || i > 56 || j > 56 || k > 56) print i, j, k }' >grid.xyz
  expect_same_mesh grid.xyz
}

test_ranks_of_samples_on_one_sphere() { # tiles are given up
  sphere 60000 >sphere.xyz
  expect_same_mesh sphere.xyz
}

test_ranks_of_few_samples() { # most ranks have none
  sphere 500 >sphere.xyz
  expect_same_mesh sphere.xyz
}

test_ranks_tell_of_errors_once() {
  ranks 3 nowhere.xyz -o mesh.ply
  equal "status" "$status" 3
  [ "$(grep -c '^eigencrust: error: ' err)" -eq 1 ] || die "not one message"
  printf '0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 1 0\n2 2 0\n' >flat.xyz
  ranks 3 flat.xyz -o mesh.ply
  equal "status" "$status" 3
  grep -q 'coplanar' err || die "another message"
  expect_files flat.xyz
}

test_ranks_end_when_one_refuses() {
  # Two lines, each sample of one a neighbour of each of the other: too many tetrahedra, on some ranks soon.
  awk 'BEGIN { for (i = 0; i < 40000; ++i) { print i / 1000, 0, 0; print 0, i / 1000, 30 } }' >lines.xyz
  ranks 3 lines.xyz -o mesh.ply --max-memory 150MB
  equal "status" "$status" 4
  [ "$(grep -c '^eigencrust: error: .*memory' err)" -eq 1 ] || die "not one message"
  expect_files lines.xyz
}

test_ranks_end_when_one_has_no_memory() {
  # Within its tile, or amid an exchange, where the others wait for it. OpenMPI itself hangs where it has no room for
  # the memory that ranks share.
  export OMPI_MCA_btl=tcp,self
  awk 'BEGIN { srand(5); for (i = 0; i < 150000; ++i) print rand(), rand(), rand() * 0.01 }' >slab.xyz
  local limit
  for limit in 85000 100000 115000; do
    status=0
    timeout 100 mpiexec -n 1 "$program" slab.xyz -o mesh.ply : \
      -n 1 bash -c "ulimit -v $limit; exec '$program' slab.xyz -o mesh.ply" >out 2>err </dev/null || status=$?
    if [ "$status" -ne 4 ] && grep -qE 'shared memory|PMIX|ORTE' err; then skip "OpenMPI does not start with $limit kB"; fi
    equal "status with $limit kB" "$status" 4
    grep -q '^eigencrust: error: memory is exhausted (rank 1' err || die "no message with $limit kB"
    expect_files slab.xyz
  done
}

test_ranks_take_every_verb_and_several_jobs() {
  sphere 30000 >a.xyz
  sphere 30000 2 >b.xyz
  ranks 3 a.xyz b.xyz --each -o '{}.ply'
  equal "status" "$status" 0
  "$ordinary" b.xyz -o one.ply -q
  same b.ply one.ply
  ranks 2 orient a.xyz -o oriented.ply
  equal "status" "$status" 0
  "$ordinary" orient a.xyz -o one.ply -q
  same oriented.ply one.ply
  ranks 2 check b.ply
  equal "status" "$status" 0
}

test_ranks_leave_nothing_when_one_is_killed() {
  command -v pgrep >/dev/null || skip "there is no pgrep"
  local job victim waited
  sphere 150000 >big.xyz
  for victim in 1 2 3; do
    : >err
    timeout 120 mpiexec -n 3 "$program" big.xyz -o mesh.ply --progress jsonl >out 2>err </dev/null &
    job=$!
    until_begun delaunay "$job" || die "it ended too early"
    kill -s KILL "$(pgrep -f "^$program big.xyz" | sort -n | sed -n "${victim}p")"
    waited=$SECONDS status=0
    wait "$job" || status=$?
    [ $((SECONDS - waited)) -lt 30 ] || die "it took $((SECONDS - waited)) s to end"
    [ "$status" -ne 0 ] || die "status 0 although a rank was killed"
    grep -q 'exited on signal 9' err || die "nobody says what happened"
    expect_files big.xyz
  done
}
