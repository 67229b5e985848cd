"""PPO by Ray RLlib on a cluster of three nodes (here on one machine): runners and a node die, and it goes on.

On several machines: `ray start --head` on one, `ray start --address=HEAD:6379` on the others, bounce_env installed on
all of them, and `ray.init(address="auto")` here in place of the cluster.
"""

import os
import shutil
import signal
import tempfile
import time
from pathlib import Path
from typing import Any

# Before Ray is imported; workers inherit it. Without the first each learner thread fights for every core.
os.environ.update(
    OMP_NUM_THREADS="1", RAY_USAGE_STATS_ENABLED="0", RAY_DEDUP_LOGS="0", RAY_DISABLE_DOCKER_CPU_WARNING="1"
)
FOLDER = tempfile.mkdtemp(prefix="r", dir="/tmp")  # short: paths of sockets have at most 107 letters
os.environ.update(HOME=FOLDER, RAY_TMPDIR=FOLDER)

import numpy as np
import ray
import torch
from held_out import BASELINES, held_out_score
from ray.cluster_utils import Cluster
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.default_model_config import DefaultModelConfig

WORLDS, STEPS, UPDATES = 256, 64, 30

cluster = Cluster(
    initialize_head=True,
    head_node_args={
        "num_cpus": 1, "object_store_memory": 200_000_000, "include_dashboard": False,
    },
)  # fmt: skip
nodes = [cluster.add_node(num_cpus=1, object_store_memory=200_000_000) for _ in range(2)]
cluster.wait_for_nodes()
ray.init(address=cluster.address, log_to_driver=False)


def config(runners: int) -> PPOConfig:
    """Return the configuration with so many runners of 256 worlds each."""
    return (
        PPOConfig()
        .environment("bounce_env:Bounce/Paddle-v0", env_config={"info": "none"})
        .env_runners(
            num_env_runners=runners,
            num_envs_per_env_runner=WORLDS,
            gym_env_vectorize_mode="vector_entry_point",
            rollout_fragment_length=STEPS,
            num_cpus_per_env_runner=1,
        )
        .fault_tolerance(restart_failed_env_runners=True, delay_between_env_runner_restarts_s=1.0)
        .learners(num_learners=0)
        .rl_module(
            model_config=DefaultModelConfig(fcnet_hiddens=[64, 64], fcnet_activation="relu", vf_share_layers=False)
        )
        .training(
            train_batch_size_per_learner=2 * WORLDS * STEPS, minibatch_size=2048, num_epochs=4,
            gamma=0.99, lambda_=0.95, lr=1e-3, grad_clip=0.5, clip_param=0.2, vf_clip_param=1e6, vf_loss_coeff=0.5,
            entropy_coeff=0.0, use_kl_loss=False,
        )
        .debugging(seed=0, log_level="ERROR")
    )  # fmt: skip


def sampled(algorithm: Any, seconds: float) -> float:
    """Return the steps a second of all runners together, sampling and nothing else."""
    group = algorithm.env_runner_group
    steps, began = 0, time.perf_counter()
    while time.perf_counter() - began < seconds:
        episodes = group.foreach_env_runner(lambda runner: sum(map(len, runner.sample())), local_env_runner=False)
        steps += sum(episodes)
    return steps / (time.perf_counter() - began)


def pids(algorithm: Any) -> list[int]:
    """Return the processes of the runners."""
    return algorithm.env_runner_group.foreach_env_runner(lambda runner: os.getpid(), local_env_runner=False)


def node_of_a_runner(algorithm: Any) -> Any:
    """Return a node, but not the head, on which a runner is."""
    group = algorithm.env_runner_group
    ids = group.foreach_env_runner(lambda runner: ray.get_runtime_context().get_node_id(), local_env_runner=False)
    return next(node for node in nodes if node.node_id in ids)


def act_of(algorithm: Any) -> Any:
    """Return the player of the present weights: the middle of its distribution."""
    module = algorithm.get_module()

    def act(observations: Any) -> Any:
        with torch.no_grad():
            told = module.forward_inference({"obs": torch.as_tensor(observations)})["action_dist_inputs"]
        return np.clip(told[:, :1].numpy(), -1.0, 1.0)

    return act


algorithm = config(2).build_algo()
for update in range(UPDATES):
    result = algorithm.train()
    if update == 9:
        os.kill(pids(algorithm)[0], signal.SIGKILL)
        print(f"update {update}: a runner was killed")
    if update == 19:
        cluster.remove_node(node_of_a_runner(algorithm))
        print(f"update {update}: a node was killed")
group = algorithm.env_runner_group
steps, restarts = int(result["num_env_steps_sampled_lifetime"]), group.num_remote_worker_restarts()
print(f"{steps:,} steps; runners were restarted {restarts} times, {group.num_healthy_remote_workers()} are healthy")
assert restarts >= 2, "a killed runner, or that of a killed node, was not restarted"
assert group.num_healthy_remote_workers() == 2

mean, half = held_out_score(act_of(algorithm))
print(f"held-out score {mean:.1f} +- {half:.1f}")
assert mean - half > 2.0 * BASELINES["Bounce/Paddle-v0"]["follow"], "no better than the player that follows the ball"

checkpoint = algorithm.save_to_path(str(Path(FOLDER) / "checkpoint"))
rates = {2: sampled(algorithm, 6.0)}
algorithm.stop()

again = config(1).build_algo()
again.restore_from_path(checkpoint)
same, _ = held_out_score(act_of(again))
assert same == mean, (same, mean)
rates[1] = sampled(again, 6.0)
result = again.train()
assert result["num_env_steps_sampled_lifetime"] > steps
print(f"restored, same score {same:.1f}; went on to {int(result['num_env_steps_sampled_lifetime']):,} steps")
print(f"sampling alone: 1 runner {rates[1]:,.0f}, 2 runners {rates[2]:,.0f} steps/s, {rates[2] / rates[1]:.2f} times")
again.stop()

ray.shutdown()
cluster.shutdown()
shutil.rmtree(FOLDER, ignore_errors=True)
