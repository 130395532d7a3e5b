"""What the commands share: options, outcomes, output, bounds of time and memory, the index of tasks."""
