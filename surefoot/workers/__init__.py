"""Who does long work: this process, others on this machine, or a cluster of machines."""
