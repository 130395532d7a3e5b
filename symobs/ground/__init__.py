"""What every floor stands on: errors, child processes, classes of named parts."""
